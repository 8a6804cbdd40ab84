#pragma once
/// Bodies of capture/mirror_sphere.hpp.

#include <gonio/capture/mirror_sphere.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

namespace gonio::capture {

GONIO_INLINE mirror_sphere::mirror_sphere(double distance) : distance_(distance) {
  if (!(distance > 1.0))
    refuse("the camera must stand outside the mirror sphere, more than one radius from its centre, not " +
           std::to_string(distance));
}

GONIO_INLINE mirror_sphere mirror_sphere::spanning(double angle) {
  if (!(angle > 0.0 && angle < std::numbers::pi))
    refuse("a mirror sphere spans an angle between 0 and 180 degrees, not " + std::to_string(degrees(angle)));
  return mirror_sphere(1.0 / std::sin(angle / 2.0));
}

GONIO_INLINE std::optional<Eigen::Vector2d> mirror_sphere::position_of(const direction& light) const noexcept {
  const double across = std::hypot(light.x(), light.y()), polar = std::atan2(across, light.z());
  if (polar > largest_polar_angle()) return {};
  const double radius = radius_of(normal_angle(polar));
  if (!(across > 0.0)) return Eigen::Vector2d(polar > 1.0 ? 1.0 : 0.0, 0.0);
  return Eigen::Vector2d(light.x(), light.y()) * (radius / across);
}

GONIO_INLINE std::optional<direction> mirror_sphere::light_at(const Eigen::Vector2d& position) const noexcept {
  const double radius = position.norm();
  if (!(radius <= 1.0)) return {};
  const double angle = angle_of(radius), polar = 2.0 * angle + leaning(angle);
  const Eigen::Vector2d across =
      radius > 0.0 ? Eigen::Vector2d(position * (std::sin(polar) / radius)) : Eigen::Vector2d::Zero();
  return direction(across.x(), across.y(), std::cos(polar));
}

GONIO_INLINE double mirror_sphere::normal_angle(double polar) const noexcept {
  double angle = polar / 2.0;
  if (is_far()) return angle;
  const double rim = std::acos(1.0 / distance_);
  for (int step = 0; step < 50; ++step) {
    const double next = std::clamp(angle - (2.0 * angle + leaning(angle) - polar) / polar_slope(angle), 0.0, rim);
    if (std::abs(next - angle) < 1e-14) return next;
    angle = next;
  }
  return angle;
}

GONIO_INLINE double mirror_sphere::angle_of(double radius) const noexcept {
  if (is_far()) return std::asin(radius);
  const double view = std::atan(radius / std::sqrt(distance_ * distance_ - 1.0));
  return std::asin(std::min(1.0, distance_ * std::sin(view))) - view;
}

GONIO_INLINE double mirror_sphere::resolution(double polar) const noexcept {
  if (!(polar <= largest_polar_angle())) return 0.0;
  const double angle = normal_angle(polar), cosine = std::cos(angle);
  const double by_angle = is_far() ? cosine
                                   : std::sqrt(distance_ * distance_ - 1.0) * (distance_ * cosine - 1.0) /
                                         ((distance_ - cosine) * (distance_ - cosine));
  return std::max(0.0, by_angle / polar_slope(angle));
}

}  // namespace gonio::capture
