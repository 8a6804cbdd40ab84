#pragma once
/// Bodies of table/valid_cells.hpp.

#include <gonio/core/assertion.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/table/grid.hpp>
#include <gonio/table/valid_cells.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace gonio {

GONIO_INLINE valid_cells::index::index(const gonio::grid& cells, double threshold)
    : grid(cells), minimum_cosine(threshold) {
  const Eigen::Index columns = grid.extents().phi_d;
  const Eigen::Index layer = grid.extents().theta_d * columns;
  const double limit = std::max(minimum_cosine, horizon);
  representative.resize(grid.size());
  linear.reserve(grid.size());
  for_each_smaller_cosine(grid, [&](Eigen::Index cell, double cosine) {
    const auto count = static_cast<std::uint32_t>(linear.size());
    if (cell % columns == 0) row_begin.push_back(count);
    if (cosine > limit) {
      representative[cell] = count;
      linear.push_back(static_cast<std::uint32_t>(cell));
    } else if (cell >= layer) {
      // The smaller cosine decreases with theta_h. The cell with the next smaller theta_h therefore already has the
      // representative.
      representative[cell] = representative[cell - layer];
    } else {
      representative[cell] = count == 0 ? 0 : count - 1;
    }
  });
  row_begin.push_back(static_cast<std::uint32_t>(linear.size()));
  if (linear.empty()) refuse("no cell of the grid has both directions above the horizon");
  for (const std::uint32_t first : row_begin) row_linear.push_back(first < linear.size() ? linear[first] : 0);
}

}  // namespace gonio
