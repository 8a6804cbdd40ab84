#pragma once
/// Bodies of design/near_field_geometry.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/pinhole_camera.hpp>
#include <gonio/design/near_field_geometry.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace gonio::design {

GONIO_INLINE pinhole_camera near_field_camera(const direction& wo, double field_of_view, Eigen::Index pixels) {
  // A ball around the disc's centre contains the disc. Seen from distance 1, its angular radius is the arcsine of its
  // radius.
  const double half = std::asin(std::tan(field_of_view / 2.0));
  const direction up = std::abs(wo.z()) > 0.999 ? direction(1.0, 0.0, 0.0) : direction(0.0, 0.0, 1.0);
  return pinhole_camera::look_at(camera_intrinsics::square(pixels, 2.0 * half), wo, Eigen::Vector3d::Zero(), up);
}

GONIO_INLINE near_field_geometry::near_field_geometry(const near_field_options& options) : options_(options) {
  const auto refuse = [](const std::string& what) { gonio::refuse("near-field images: " + what); };
  if (!(options.field_of_view > 0.0 && options.field_of_view < std::numbers::pi / 2.0))
    refuse("the field of view must be from 0 to 90 degrees, not " + std::to_string(degrees(options.field_of_view)));
  if (options.pixels == 0) refuse("the number of pixels must be above 0");
  if (!(options.step > 0.0)) refuse("the step between candidates must be positive");
  if (!(options.largest_polar_angle > 0.0 && options.largest_polar_angle < std::numbers::pi / 2.0))
    refuse("the largest polar angle must be between 0 and 90 degrees, not " +
           std::to_string(degrees(options.largest_polar_angle)));
  for (const auto& fixed : {options.fixed_camera, options.fixed_light})
    if (fixed && !(*fixed >= 0.0 && *fixed < std::numbers::pi / 2.0))
      refuse("a fixed direction must be above the horizon, not at " + std::to_string(degrees(*fixed)) + " degrees");
  const auto steps = [&](double range) { return 1 + static_cast<int>(std::floor(range / options.step + 1e-9)); };
  extents_ = {options.fixed_light ? 1 : steps(options.largest_polar_angle),
              options.fixed_camera ? 1 : steps(options.largest_polar_angle), steps(std::numbers::pi)};
  bool any = false;
  for (Eigen::Index candidate = 0; candidate < size() && !any; ++candidate) any = allows(candidate);
  if (!any)
    refuse(
        "no directions of light and camera satisfy the limits of the apparatus (--apparatus, --constraint, "
        "--separation)");
}

GONIO_INLINE bool near_field_geometry::allows(Eigen::Index candidate) const {
  const grid_step at = position_of(candidate);
  const direction_pair pose = centre(candidate);
  const bool at_zenith = polar(options_.fixed_light, at[0]) == 0.0 || polar(options_.fixed_camera, at[1]) == 0.0;
  return !(at_zenith && at[2] > 0) && options_.constraint(pose);
}

GONIO_INLINE direction_pair near_field_geometry::centre(Eigen::Index candidate) const {
  const grid_step at = position_of(candidate);
  return {spherical_direction(polar(options_.fixed_light, at[0]), options_.step * at[2]),
          spherical_direction(polar(options_.fixed_camera, at[1]), 0.0)};
}

GONIO_INLINE Eigen::Index near_field_geometry::nearest(const direction_pair& pair) const {
  const auto step_of = [&](double angle, int extent) {
    return std::clamp(static_cast<int>(std::lround(angle / options_.step)), 0, extent - 1);
  };
  const double azimuth = std::atan2(std::abs(pair.wo.x() * pair.wi.y() - pair.wo.y() * pair.wi.x()),
                                    pair.wo.x() * pair.wi.x() + pair.wo.y() * pair.wi.y());
  grid_step at{step_of(polar_angle(pair.wi), extents_[0]), step_of(polar_angle(pair.wo), extents_[1]),
               step_of(azimuth, extents_[2])};
  if (!allows(number(at))) at[2] = 0;
  return number(at);
}

GONIO_INLINE std::vector<half_difference> near_field_geometry::directions(Eigen::Index candidate) const {
  const direction_pair pose = centre(candidate);
  const double radius = std::tan(options_.field_of_view / 2.0);
  const pinhole_camera camera = near_field_camera(pose.wo, options_.field_of_view, options_.pixels);
  std::vector<half_difference> seen;
  for (Eigen::Index row = 0; row < options_.pixels; ++row)
    for (Eigen::Index column = 0; column < options_.pixels; ++column) {
      const ray line = camera.ray_through(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
      const auto point = line.at_ground();
      if (point && point->norm() <= radius) seen.push_back(to_half_difference(pose.wi, -line.towards));
    }
  if (seen.empty()) seen.push_back(to_half_difference(pose.wi, pose.wo));
  return seen;
}

GONIO_INLINE std::optional<Eigen::Index> near_field_geometry::stepped(Eigen::Index from, const grid_step& step) const {
  grid_step at = position_of(from);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    at[axis] += step[axis];
    if (at[axis] < 0 || at[axis] >= extents_[axis]) return {};
  }
  if (!allows(number(at))) return {};
  return number(at);
}

}  // namespace gonio::design
