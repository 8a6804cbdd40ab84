#pragma once
/// Bodies of io/near_field_setup.hpp.

#include <gonio/capture/near_field_image.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/io/near_field_setup.hpp>
#include <gonio/io/rules.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE setup_text::setup_text(std::string_view text, const std::string& name, std::span<const setup_entry> known)
    : name_(name), known_(known) {
  text_place place{name};
  for_each_line(text, place, [&](std::string_view line) { add(parse_rule(line, place), place); });
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
  for (const std::string_view name : names) missing += (missing.empty() ? "" : " or ") + quoted(name);
  gonio::refuse({name_, ": ", missing, " is missing"});
}

GONIO_INLINE void setup_text::add(text_rule rule, const text_place& place) {
  const auto known = std::ranges::find(known_, rule.name, &setup_entry::name);
  if (known == known_.end()) {
    std::string names;
    for (const setup_entry& entry : known_) names += (names.empty() ? "" : ", ") + std::string(entry.name);
    place.refuse(quoted(rule.name) + " is unknown, expected one of " + names);
  }
  if (const placed_rule* before = find(rule.name))
    place.refuse(quoted(rule.name) + " is already in line " + std::to_string(before->place.line));
  if (known->or_numbers > 0)
    require_numbers(rule, {known->numbers, known->or_numbers}, place);
  else
    require_numbers(rule, {known->numbers}, place);
  rules_.push_back({std::move(rule), place});
}

GONIO_INLINE const setup_text::placed_rule* setup_text::find(std::string_view name) const {
  const auto found = std::ranges::find(rules_, name, [](const placed_rule& each) { return each.rule.name; });
  return found == rules_.end() ? nullptr : &*found;
}

GONIO_INLINE const setup_text::placed_rule& setup_text::at(std::string_view name) const {
  require({name});
  return *find(name);
}

GONIO_INLINE camera_intrinsics setup_intrinsics(const setup_text& text) {
  camera_intrinsics intrinsics;
  intrinsics.columns = text.count("size", 0, 1);
  intrinsics.rows = text.count("size", 1, 1);
  const auto& focal_length = text.numbers("focal_length");
  intrinsics.focal_length_x = focal_length.front();
  intrinsics.focal_length_y = focal_length.back();
  set_principal_point(text, intrinsics);
  return intrinsics;
}

GONIO_INLINE void set_principal_point(const setup_text& text, camera_intrinsics& intrinsics) {
  const bool given = text.has("principal_point");
  intrinsics.principal_x = given ? text.numbers("principal_point")[0] : static_cast<double>(intrinsics.columns) / 2.0;
  intrinsics.principal_y = given ? text.numbers("principal_point")[1] : static_cast<double>(intrinsics.rows) / 2.0;
}

GONIO_INLINE pinhole_camera setup_camera(const setup_text& text, const camera_intrinsics& intrinsics) {
  const Eigen::Vector3d position = text.vector("position");
  text.require({"target", "rotation"});
  for (const std::string_view other : {"target", "up"}) text.require_one_of("rotation", other, "how the camera stands");
  if (text.has("rotation")) {
    using row_major = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    const Eigen::Matrix3d rotation = row_major::Map(text.numbers("rotation").data());
    return text.naming_file([&] { return pinhole_camera(intrinsics, rotation, position); });
  }
  const Eigen::Vector3d target = text.vector("target");
  const Eigen::Vector3d up = text.has("up") ? text.vector("up") : Eigen::Vector3d(0.0, 0.0, 1.0);
  return text.naming_file([&] { return pinhole_camera::look_at(intrinsics, position, target, up); });
}

GONIO_INLINE directional_light setup_light(const setup_text& text) {
  directional_light light;
  text.require({"light", "light_angles"});
  text.require_one_of("light", "light_angles", "where the light is");
  if (text.has("light")) {
    light.towards = text.vector("light");
    const double length = light.towards.norm();
    if (!(length > 0.0 && std::isfinite(length))) text.refuse("light", "a direction needs a length that is not 0");
    light.towards /= length;
  } else {
    const double theta = text.numbers("light_angles")[0], phi = text.numbers("light_angles")[1];
    if (!(theta >= 0.0 && theta < 90.0))
      text.refuse("light_angles", shortest(theta) + " degrees, expected at least 0 and less than 90");
    if (!(std::abs(phi) <= 360.0)) text.refuse("light_angles", shortest(phi) + " degrees, expected from -360 to 360");
    light.towards = spherical_direction(radians(theta), radians(phi));
  }
  if (text.has("irradiance")) {
    const auto& values = text.numbers("irradiance");
    light.irradiance = values.size() == 1 ? rgb::Constant(values[0]) : rgb(values[0], values[1], values[2]);
  }
  return light;
}

GONIO_INLINE capture::near_field_setup make_setup(const setup_text& text) {
  capture::near_field_setup setup{.camera = setup_camera(text, setup_intrinsics(text)), .light = setup_light(text)};
  text.require({"region", "window"});
  if (text.has("region")) {
    const auto& region = text.numbers("region");
    setup.disc = capture::sample_disc{region[0]};
    if (region.size() == 3) setup.disc->centre = {region[1], region[2]};
  }
  if (text.has("window"))
    setup.window = capture::pixel_window{text.count("window", 0, 0), text.count("window", 1, 0),
                                         text.count("window", 2, 1), text.count("window", 3, 1)};
  if (text.has("saturation")) setup.saturation = text.numbers("saturation")[0];
  if (text.has("block")) setup.block = text.count("block", 0, 1);
  return setup;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE capture::near_field_setup parse_near_field_setup(std::string_view text, const std::string& name) {
  const detail::setup_text entries(text, name);
  capture::near_field_setup setup = detail::make_setup(entries);
  entries.naming_file([&] { require_usable(setup); });
  return setup;
}

GONIO_INLINE capture::near_field_setup read_near_field_setup(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  return parse_near_field_setup(detail::as_text(bytes), path.string());
}

}  // namespace gonio::io
