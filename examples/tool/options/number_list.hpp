#pragma once
/// Lists of numbers on the command line, such as 0.5,-1,2.

#include <string_view>
#include <vector>

namespace cli {

/// Returns the numbers between the commas. Throws gonio::error that names the option and the wrong number.
[[nodiscard]] std::vector<double> numbers_in(std::string_view list, std::string_view option);

}  // namespace cli
