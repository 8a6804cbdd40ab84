#pragma once
/// Dips and rings: departures of a table's luminance from the steady decrease with theta_h that most materials show.

#include <gonio/core/rgb.hpp>
#include <gonio/table/brdf_table.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace papers {

struct highlight_shape {
  /// Luminance at theta_h = 0 relative to the largest luminance below 8 degrees: the smallest ratio of all curves.
  double mirror = 1.0;
  double turning_points = 0.0;  ///< number of turning points at theta_h below 45 degrees, averaged over the curves
};

/// Counts the turning points of a curve of logarithms, with changes of more than 2 %.
[[nodiscard]] inline int turning_points(const std::vector<double>& curve) {
  constexpr double visible = 0.02;
  int turns = 0, direction = 0;
  double low = curve.front(), high = low, extreme = low;
  for (const double value : curve) {
    if (direction == 0) {
      low = std::min(low, value);
      high = std::max(high, value);
      direction = value < high - visible ? -1 : value > low + visible ? 1 : 0;
      extreme = value;
    } else if (direction * (value - extreme) > 0.0) {
      extreme = value;
    } else if (direction * (value - extreme) < -visible) {
      direction = -direction;
      extreme = value;
      ++turns;
    }
  }
  return turns;
}

/// Examines the curves of luminance over theta_h at theta_d up to 75 degrees. `mirror` uses only theta_d up to 65
/// degrees.
[[nodiscard]] inline highlight_shape highlight_shape_of(const gonio::brdf_table& table) {
  const gonio::valid_cells& cells = table.cells();
  const gonio::grid_extents size = cells.grid().extents();
  highlight_shape found;
  double curves = 0.0;
  for (int theta_d = 0; cells.grid().theta_d(theta_d) < gonio::radians(75.0); ++theta_d)
    for (int phi_d = 0; phi_d < size.phi_d; ++phi_d) {
      std::vector<double> curve;
      double brightest = 0.0;
      for (int theta_h = 0; cells.grid().theta_h(theta_h) < gonio::radians(45.0); ++theta_h) {
        const Eigen::Index cell = cells.grid().linear({theta_h, theta_d, phi_d});
        if (!cells.contains(cell)) break;
        const double value = std::max(gonio::luminance(gonio::rgb(table.at(cells.representative(cell)))), 1e-9);
        if (cells.grid().theta_h(theta_h) < gonio::radians(8.0)) brightest = std::max(brightest, value);
        curve.push_back(std::log(value));
      }
      if (curve.empty()) continue;
      if (cells.grid().theta_d(theta_d) < gonio::radians(65.0))
        found.mirror = std::min(found.mirror, std::exp(curve.front()) / brightest);
      found.turning_points += turning_points(curve);
      curves += 1.0;
    }
  found.turning_points /= curves;
  return found;
}

}  // namespace papers
