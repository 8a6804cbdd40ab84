#pragma once
/// Pairs of directions on an isotropic surface.

#include <gonio/core/direction.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace gonio {

/// A pair of directions up to a rotation about the normal: their polar angles and the azimuth from light to viewer,
/// radians. Unlike half and difference angles, these are continuous at the mirror direction.
struct turned_pair {
  double theta_i, theta_o, azimuth;

  explicit turned_pair(const direction_pair& pair)
      : theta_i(polar_angle(pair.wi)),
        theta_o(polar_angle(pair.wo)),
        azimuth(gonio::azimuth(pair.wo) - gonio::azimuth(pair.wi)) {}

  /// Returns the pair with light and viewer swapped.
  [[nodiscard]] turned_pair swapped() const noexcept {
    turned_pair other = *this;
    std::swap(other.theta_i, other.theta_o);
    other.azimuth = -azimuth;
    return other;
  }

  /// Returns true if two pairs agree within a tolerance. A difference of azimuth counts as the angle by which it moves
  /// the direction nearer to the normal.
  [[nodiscard]] bool agrees(const turned_pair& other, double tolerance) const noexcept {
    if (std::abs(theta_i - other.theta_i) > tolerance || std::abs(theta_o - other.theta_o) > tolerance) return false;
    const double turn = std::abs(std::remainder(azimuth - other.azimuth, 2.0 * std::numbers::pi));
    return turn * std::sin(std::min(theta_i, theta_o)) <= tolerance;
  }
};

}  // namespace gonio
