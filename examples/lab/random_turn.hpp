#pragma once
/// Random rotations, for simulated misalignment.

#include <gonio/core/direction.hpp>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <random>

namespace lab {

/// Returns a rotation by an angle in radians about an axis that is uniform on the sphere.
[[nodiscard]] inline Eigen::Matrix3d random_turn(double angle, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> height(-1.0, 1.0), azimuth(0.0, 2.0 * std::numbers::pi);
  const double z = height(generator);
  const gonio::direction axis = gonio::spherical_direction(std::acos(z), azimuth(generator));
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

}  // namespace lab
