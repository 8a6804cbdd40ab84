#include "lights.hpp"

#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/text/text.hpp>

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace cli {

namespace {

/// Returns the light of a text such as 45,35: degrees to the right of the camera, and above it.
gonio::direction light_of(const std::string& text) {
  std::vector<std::string_view> fields;
  gonio::io::split_fields(text, fields);
  if (fields.size() != 2) gonio::refuse({"--light needs two angles, as 45,35, not ", gonio::io::in_quotes(text)});
  std::array<double, 2> angles{};
  for (std::size_t i = 0; i < 2; ++i)
    if (const char* wrong = gonio::io::read_number(fields[i], angles[i]))
      gonio::refuse({"--light: ", gonio::io::in_quotes(fields[i]), ",", wrong});
  if (std::abs(angles[0]) > 180.0 || std::abs(angles[1]) > 90.0)
    gonio::refuse({"--light needs an angle from -180 to 180 and one from -90 to 90, not ", gonio::io::in_quotes(text)});
  const double right = gonio::radians(angles[0]), up = gonio::radians(angles[1]);
  return {std::sin(right) * std::cos(up), std::sin(up), std::cos(right) * std::cos(up)};
}

}  // namespace

option add_light_option(command& to, std::vector<std::string>& lights) {
  return to
      .add_option("--light", lights,
                  "Direction of a light instead of the two default lights: degrees to the right of the camera and "
                  "above it, as 45,35. May be given several times")
      .repeatable();
}

gonio::render::directional_lighting lighting_of(const std::vector<std::string>& given) {
  if (given.empty()) return gonio::render::two_lights();
  std::vector<gonio::directional_light> lights;
  for (const std::string& text : given) lights.push_back({light_of(text)});
  return gonio::render::directional_lighting(std::move(lights));
}

}  // namespace cli
