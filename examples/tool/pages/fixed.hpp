#pragma once
/// Numbers formatted for people.

#include <cstddef>
#include <string>

namespace cli {

class json;

/// Returns a number with a fixed number of digits after the point.
[[nodiscard]] std::string fixed(double value, int digits);
[[nodiscard]] std::string fixed(const json& value, int digits);

/// Returns a number with three significant digits, such as 0.00123 or 1.23e-05.
[[nodiscard]] std::string significant(double value);

/// Returns a reflectance in sr^-1 in three or four digits, the precision of measurements.
[[nodiscard]] std::string reflectance(double value);

/// Returns "known to 6 %" for a relative deviation of 0.06; "not known" if it is 2, a factor of 3, or more.
[[nodiscard]] std::string known_to(double relative_deviation, int digits = 0);

/// Returns "1 sample" or "20 samples".
[[nodiscard]] std::string counted(std::ptrdiff_t count, const std::string& thing);

}  // namespace cli
