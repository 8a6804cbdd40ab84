#pragma once
/// Numbers as people read them.

#include <cstddef>
#include <string>

namespace cli {

class json;

/// A number in a table for people.
[[nodiscard]] std::string fixed(double value, int digits);
[[nodiscard]] std::string fixed(const json& value, int digits);

/// A reflectance in sr^-1 for people, in three or four digits: more are not known.
[[nodiscard]] std::string reflectance(double value);

/// "1 sample", "20 samples".
[[nodiscard]] std::string counted(std::ptrdiff_t count, const std::string& thing);

}  // namespace cli
