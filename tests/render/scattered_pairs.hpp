#pragma once
/// Pairs of directions for comparing methods of finding a cell, and the largest allowed error.

#include <gonio/table/grid.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace scattered {

using gonio::direction;

/// Uniform above the horizon, or close to each other's mirror direction, to the normal or to the horizon.
inline gonio::direction_pair scattered_pair(std::mt19937_64& generator, int kind) {
  std::uniform_real_distribution<double> uniform;
  const auto any = [&](double lowest, double highest) {
    const double z = lowest + (highest - lowest) * uniform(generator), azimuth = 6.3 * uniform(generator);
    return gonio::spherical_direction(std::acos(z), azimuth);
  };
  direction wi = any(1e-3, 1.0), wo = any(1e-3, 1.0);
  const double angle = 0.02 * uniform(generator), side = 6.3 * uniform(generator);
  if (kind == 1) wo = gonio::turned({-wi.x(), -wi.y(), wi.z()}, angle, side);
  if (kind == 2) wi = any(0.9999, 1.0);
  if (kind == 3) wo = any(1e-6, 1e-2);
  if (wo.z() <= 0.0) wo.z() = 1e-6;
  return {wi, wo.normalized()};
}

/// Returns the distance, in cells, between exact angles and a cell, along the axis where it is largest.
inline double outside(const gonio::grid& cells, const gonio::cell_index& cell, const gonio::half_difference& angles) {
  const auto beyond = [](double coordinate, int begin) {
    return std::max({0.0, begin - coordinate, coordinate - (begin + 1)});
  };
  const int columns = cells.extents().phi_d;
  const double phi = cells.phi_d_coordinate(angles.phi_d) + 0.5;
  const double off_phi =
      std::min(beyond(phi, cell.phi_d), beyond(phi < 1.0 ? phi + columns : phi - columns, cell.phi_d));
  // Errors of phi_d count less as the difference vector shrinks, since phi_d is undefined for equal directions.
  return std::max({beyond(cells.theta_h_coordinate(angles.theta_h) + 0.5, cell.theta_h),
                   beyond(cells.theta_d_coordinate(angles.theta_d) + 0.5, cell.theta_d),
                   off_phi * std::sin(angles.theta_d) * std::sin(angles.theta_h)});
}

}  // namespace scattered
