#pragma once
/// Bodies of evaluate/comparison.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/metric/error_metric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace gonio {

GONIO_INLINE rgb highlight_peak(const brdf_table& table, double largest_theta_d) {
  const valid_cells& cells = table.cells();
  // Cells are ordered by theta_h, so the cells of the highlight come first.
  const double limit = std::max(radians(5.0), std::nextafter(cells.angles(0).theta_h, 2.0));
  std::vector<Eigen::Index> near;
  for (Eigen::Index cell = 0; cell < cells.size() && cells.angles(cell).theta_h < limit; ++cell)
    if (cells.angles(cell).theta_d <= largest_theta_d) near.push_back(cell);
  if (near.empty()) near.push_back(0);

  rgb peak;
  std::vector<float> values(near.size());
  const std::ptrdiff_t last = std::ssize(near) - 1;
  const double position = 0.999 * static_cast<double>(last);
  const auto below = static_cast<std::ptrdiff_t>(position);
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    for (Eigen::Index i = 0; i < std::ssize(near); ++i) values[i] = table.values()[3 * near[i] + channel];
    const float lower = nth_smallest(values, below), next = nth_smallest(values, std::min(below + 1, last));
    const double percentile = lower + (position - static_cast<double>(below)) * (double{next} - lower);
    peak[channel] = std::max(percentile, 0.0);
  }
  return peak;
}

}  // namespace gonio
