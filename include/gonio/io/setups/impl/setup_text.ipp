#pragma once
/// Bodies of io/setups/setup_text.hpp.

#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/surface_light.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/io/setups/camera_calibration.hpp>
#include <gonio/io/setups/setup_text.hpp>
#include <gonio/io/text/rules.hpp>
#include <gonio/io/text/text.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace gonio::io::detail {

GONIO_INLINE setup_text::setup_text(std::string_view text, const std::string& name, std::span<const setup_entry> known)
    : name_(name), known_(known) {
  text_position position{name};
  for_each_line(text, position, [&](std::string_view line) { add(read_rule(line, position), position); });
}

GONIO_INLINE std::size_t setup_text::count(std::string_view name, std::size_t which, std::size_t smallest) const {
  constexpr std::size_t most = 1'000'000;
  const double value = numbers(name)[which];
  if (!(value >= static_cast<double>(smallest) && value <= static_cast<double>(most) && value == std::floor(value)))
    refuse(name,
           shortest(value) + " is not a whole number from " + std::to_string(smallest) + " to " + std::to_string(most));
  return static_cast<std::size_t>(value);
}

GONIO_INLINE void setup_text::require(std::initializer_list<std::string_view> names) const {
  if (std::ranges::any_of(names, [&](std::string_view name) { return has(name); })) return;
  std::string missing;
  for (const std::string_view name : names) missing += (missing.empty() ? "" : " or ") + in_quotes(name);
  gonio::refuse({name_, ": ", missing, " is missing"});
}

GONIO_INLINE void setup_text::add(text_rule rule, const text_position& position) {
  const auto known = std::ranges::find(known_, rule.name, &setup_entry::name);
  if (known == known_.end()) {
    std::string names;
    for (const setup_entry& entry : known_) names += (names.empty() ? "" : ", ") + std::string(entry.name);
    position.refuse(in_quotes(rule.name) + " is unknown, expected one of " + names);
  }
  if (const stated_rule* before = find(rule.name))
    position.refuse(in_quotes(rule.name) + " is already in line " + std::to_string(before->position.line));
  if (known->or_numbers > 0)
    require_numbers(rule, {known->numbers, known->or_numbers}, position);
  else
    require_numbers(rule, {known->numbers}, position);
  rules_.push_back({std::move(rule), position});
}

GONIO_INLINE const setup_text::stated_rule* setup_text::find(std::string_view name) const {
  const auto found = std::ranges::find(rules_, name, [](const stated_rule& each) { return each.rule.name; });
  return found == rules_.end() ? nullptr : &*found;
}

GONIO_INLINE const setup_text::stated_rule& setup_text::at(std::string_view name) const {
  require({name});
  return *find(name);
}

/// Returns the focal length in pixels from the field of view between the image's left and right borders.
GONIO_INLINE double focal_length_of_view(const setup_text& text, double columns) {
  const double angle = text.numbers("field_of_view")[0];
  if (!(angle > 0.0 && angle < 180.0))
    text.refuse("field_of_view", shortest(angle) + " degrees, expected above 0 and below 180");
  return 0.5 * columns / std::tan(0.5 * radians(angle));
}

GONIO_INLINE camera_intrinsics setup_intrinsics(const setup_text& text) {
  camera_intrinsics intrinsics;
  intrinsics.columns = text.count("size", 0, 1);
  intrinsics.rows = text.count("size", 1, 1);
  const auto columns = static_cast<double>(intrinsics.columns), rows = static_cast<double>(intrinsics.rows);
  text.require({"focal_length", "field_of_view"});
  text.require_one_of("field_of_view", "focal_length", "the field of view");
  if (text.has("focal_length")) {
    intrinsics.focal_length_x = text.numbers("focal_length").front();
    intrinsics.focal_length_y = text.numbers("focal_length").back();
  } else {
    intrinsics.focal_length_x = intrinsics.focal_length_y = focal_length_of_view(text, columns);
  }
  const bool given = text.has("principal_point");
  intrinsics.principal_x = given ? text.numbers("principal_point")[0] : columns / 2.0;
  intrinsics.principal_y = given ? text.numbers("principal_point")[1] : rows / 2.0;
  return intrinsics;
}

GONIO_INLINE pinhole_camera posed_camera(const setup_text& text, const camera_intrinsics& intrinsics) {
  const Eigen::Vector3d position = text.vector("position");
  text.require({"target", "rotation"});
  for (const std::string_view other : {"target", "up"})
    text.require_one_of("rotation", other, "the camera's orientation");
  if (text.has("rotation")) {
    using row_major = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    const Eigen::Matrix3d rotation = row_major::Map(text.numbers("rotation").data());
    return text.naming_file([&] { return pinhole_camera(intrinsics, rotation, position); });
  }
  const Eigen::Vector3d target = text.vector("target");
  const Eigen::Vector3d up = text.has("up") ? text.vector("up") : Eigen::Vector3d(0.0, 0.0, 1.0);
  return text.naming_file([&] { return pinhole_camera::look_at(intrinsics, position, target, up); });
}

GONIO_INLINE lens_distortion setup_distortion(const setup_text& text) {
  if (!text.has("distortion")) return {};
  const auto& all = text.numbers("distortion");
  return {.k1 = all[0], .k2 = all[1], .p1 = all[2], .p2 = all[3], .k3 = all.size() > 4 ? all[4] : 0.0};
}

GONIO_INLINE lens_camera setup_camera(const setup_text& text, const std::optional<camera_calibration>& calibration) {
  if (calibration)
    for (const std::string_view entry : {"size", "focal_length", "field_of_view", "principal_point", "distortion"})
      if (text.has(entry)) text.refuse(entry, "the calibration already states it, give only one of them");
  const pinhole_camera pinhole = posed_camera(text, calibration ? calibration->intrinsics : setup_intrinsics(text));
  const lens_distortion distortion = calibration ? calibration->distortion : setup_distortion(text);
  return text.naming_file([&] { return lens_camera(pinhole, distortion); });
}

/// Returns an entry's colour: three numbers, or one for all channels, or 1 if the entry is missing.
GONIO_INLINE rgb setup_colour(const setup_text& text, std::string_view name) {
  if (!text.has(name)) return rgb::Ones();
  const auto& values = text.numbers(name);
  const rgb colour = values.size() == 1 ? rgb::Constant(values[0]) : rgb(values[0], values[1], values[2]);
  if (!(colour > 0.0).all()) text.refuse(name, "must be positive in each channel");
  return colour;
}

GONIO_INLINE directional_light distant_light(const setup_text& text) {
  directional_light light;
  if (text.has("light")) {
    light.towards = text.vector("light");
    const double length = light.towards.norm();
    if (!(length > 0.0 && std::isfinite(length))) text.refuse("light", "the direction must be finite and not 0 0 0");
    light.towards /= length;
  } else {
    const double theta = text.numbers("light_angles")[0], phi = text.numbers("light_angles")[1];
    if (!(theta >= 0.0 && theta < 90.0))
      text.refuse("light_angles", shortest(theta) + " degrees, expected at least 0 and less than 90");
    if (!(std::abs(phi) <= 360.0)) text.refuse("light_angles", shortest(phi) + " degrees, expected from -360 to 360");
    light.towards = spherical_direction(radians(theta), radians(phi));
  }
  light.irradiance = setup_colour(text, "irradiance");
  if (text.has("light_half_angle")) light.half_angle = radians(text.numbers("light_half_angle")[0]);
  if (!(light.half_angle >= 0.0 && light.half_angle <= largest_half_angle))
    text.refuse("light_half_angle", "expected from 0 to 45 degrees");
  return light;
}

GONIO_INLINE capture::surface_light setup_light(const setup_text& text) {
  text.require({"light", "light_angles", "lamp"});
  for (const auto& [one, other] : {std::pair{"light", "light_angles"}, {"light", "lamp"}, {"light_angles", "lamp"}})
    text.require_one_of(one, other, "the light's location");
  if (!text.has("lamp")) {
    if (text.has("intensity")) text.refuse("intensity", "belongs to a lamp, for a distant light give irradiance");
    if (text.has("lamp_radius"))
      text.refuse("lamp_radius", "belongs to a lamp, for a distant light give light_half_angle");
    return distant_light(text);
  }
  if (text.has("irradiance")) text.refuse("irradiance", "belongs to a distant light, for a lamp give intensity");
  if (text.has("light_half_angle"))
    text.refuse("light_half_angle", "belongs to a distant light, for a lamp give lamp_radius");
  const double radius = text.has("lamp_radius") ? text.numbers("lamp_radius")[0] : 0.0;
  if (!(radius >= 0.0)) text.refuse("lamp_radius", "must not be negative");
  return capture::point_lamp{text.vector("lamp"), setup_colour(text, "intensity"), radius};
}

GONIO_INLINE white_entries setup_white(const setup_text& text) {
  if (text.has("white_plane") && !text.has("white_reflectance"))
    text.refuse("white_plane", "needs 'white_reflectance'");
  if (!text.has("white_reflectance")) return {};
  white_entries white{text.numbers("white_reflectance")[0]};
  if (!(*white.reflectance > 0.0 && *white.reflectance <= 1.0))
    text.refuse("white_reflectance", shortest(*white.reflectance) + ", expected above 0 and up to 1");
  if (!text.has("white_plane")) return white;
  const auto& plane = text.numbers("white_plane");
  white.plane = {{plane[0], plane[1], plane[2]}, {plane[3], plane[4], plane[5]}};
  return white;
}

}  // namespace gonio::io::detail
