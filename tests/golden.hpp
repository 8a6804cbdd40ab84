#pragma once
/// Golden files of the Python reference: numbers in CSV with a header line, and JSON.

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

/// Columns by name.
using golden_columns = std::map<std::string, std::vector<double>>;

inline golden_columns golden_csv(const std::string& name) {
  std::ifstream file(std::string(GONIO_TEST_DATA) + "/" + name);
  REQUIRE_MESSAGE(file.good(), "missing test data ", name);
  std::string line, field;
  std::getline(file, line);
  std::vector<std::string> names;
  for (std::istringstream fields(line); std::getline(fields, field, ',');) names.push_back(field);
  golden_columns columns;
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    for (const std::string& column : names) {
      REQUIRE(std::getline(fields, field, ','));
      columns[column].push_back(std::stod(field));
    }
  }
  return columns;
}

inline nlohmann::json golden_json(const std::string& name) {
  std::ifstream file(std::string(GONIO_TEST_DATA) + "/" + name);
  REQUIRE_MESSAGE(file.good(), "missing test data ", name);
  return nlohmann::json::parse(file);
}
