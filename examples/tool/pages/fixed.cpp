#include "fixed.hpp"

#include "tool/files/json.hpp"

#include <cstdio>

namespace cli {

std::string fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string fixed(const json& value, int digits) { return fixed(value.number(), digits); }

std::string significant(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string reflectance(double value) { return fixed(value, value < 0.1 ? 4 : value < 10.0 ? 3 : 1); }

std::string known_to(double relative_deviation, int digits) {
  constexpr double largest_known = 2.0;  // as on the pages (examples/report/readings.js)
  if (relative_deviation >= largest_known) return "not known";
  return "known to " + fixed(100.0 * relative_deviation, digits) + " %";
}

std::string counted(std::ptrdiff_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

}  // namespace cli
