#pragma once
/// Golden files of the Python reference: numbers in CSV with a header line. json.hpp has those in JSON.

#include <map>
#include <string>
#include <vector>

/// Columns by name.
using golden_columns = std::map<std::string, std::vector<double>>;

[[nodiscard]] golden_columns golden_csv(const std::string& name);
