#pragma once
/// Bodies of capture/trajectory.hpp.

#include <gonio/capture/trajectory.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace gonio::capture {

GONIO_INLINE Eigen::Quaterniond camera_pose::orientation() const {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY());
}

GONIO_INLINE direction camera_pose::looks_along() const { return orientation() * Eigen::Vector3d::UnitX(); }

GONIO_INLINE void camera_sphere::require_usable() const {
  if (!(radius > 0.0) || !std::isfinite(radius) || !centre.allFinite() || !std::isfinite(arc_azimuth))
    refuse("a camera's sphere needs a positive radius and finite numbers");
}

GONIO_INLINE camera_pose camera_sphere::towards(const direction& wo) const {
  const double theta = polar_angle(wo), phi = azimuth(wo) + arc_azimuth;
  return {centre + radius * spherical_direction(theta, phi), std::numbers::pi / 2.0 + theta, phi};
}

GONIO_INLINE direction camera_sphere::seen_from(const camera_pose& pose) const {
  return turned_about_normal((pose.position - centre).normalized(), -arc_azimuth);
}

GONIO_INLINE direction tool_pose::looks_along() const {
  return Eigen::Quaterniond(quaternion[0], quaternion[1], quaternion[2], quaternion[3]) * Eigen::Vector3d::UnitX();
}

GONIO_INLINE std::vector<tool_pose> tool_path(const camera_sphere& sphere, std::span<const direction> directions) {
  sphere.require_usable();
  std::vector<tool_pose> path;
  Eigen::Vector4d before = Eigen::Vector4d::UnitX();
  for (const direction& towards : directions) {
    const camera_pose pose = sphere.towards(towards);
    const Eigen::Quaterniond turn = pose.orientation();
    const Eigen::Vector4d quaternion(turn.w(), turn.x(), turn.y(), turn.z());
    before = quaternion.dot(before) < 0.0 ? -quaternion : quaternion;
    path.push_back({pose.position, before});
  }
  return path;
}

GONIO_INLINE int angular_grid::steps_to_horizon() const {
  const double steps = std::numbers::pi / 2.0 / step;
  if (!(step > 0.0) || !(steps >= 1.0) || std::abs(steps - std::round(steps)) > 1e-9)
    refuse("steps of " + std::to_string(degrees(step)) + " degrees do not divide a right angle");
  return static_cast<int>(std::lround(steps));
}

GONIO_INLINE std::vector<direction> arc_lamps(const angular_grid& grid) {
  const int steps = grid.steps_to_horizon();
  std::vector<direction> lamps;
  for (int i = 1 - steps; i < steps; ++i)
    lamps.push_back(spherical_direction(std::abs(i) * grid.step, i < 0 ? std::numbers::pi : 0.0));
  return lamps;
}

GONIO_INLINE std::vector<direction> half_hemisphere(const angular_grid& grid) {
  const int steps = grid.steps_to_horizon();
  std::vector<direction> seen;
  for (int row = steps - 1; row > 0; --row)
    for (int column = 0; column <= 2 * steps; ++column)
      seen.push_back(spherical_direction(row * grid.step, column * grid.step));
  seen.push_back(spherical_direction(0.0, 0.0));
  return seen;
}

GONIO_INLINE direction_pair above_arc(const direction_pair& pair) {
  const double turn = polar_angle(pair.wi) > 0.0 ? azimuth(pair.wi) : azimuth(pair.wo);
  direction_pair turned{turned_about_normal(pair.wi, -turn), turned_about_normal(pair.wo, -turn)};
  turned.wo.y() = std::abs(turned.wo.y());
  return turned;
}

GONIO_INLINE std::vector<Eigen::Index> short_way(const std::vector<direction>& directions) {
  return short_way(directions.size(),
                   [&](Eigen::Index i, Eigen::Index j) { return angle_between(directions[i], directions[j]); });
}

GONIO_INLINE double length_of_way(const std::vector<direction>& directions, const std::vector<Eigen::Index>& order) {
  double length = 0.0;
  for (Eigen::Index i = 1; i < std::ssize(order); ++i)
    length += angle_between(directions[order[i - 1]], directions[order[i]]);
  return length;
}

GONIO_INLINE double duration_of_scan(double length_of_way, Eigen::Index stops, Eigen::Index lamps,
                                     const scan_pace& pace) {
  if (!(pace.radians_per_second > 0.0)) refuse("a robot's speed must be positive");
  const double each = pace.settling + static_cast<double>(lamps) * (pace.exposure + pace.switching);
  return length_of_way / pace.radians_per_second + static_cast<double>(stops) * each;
}

}  // namespace gonio::capture
