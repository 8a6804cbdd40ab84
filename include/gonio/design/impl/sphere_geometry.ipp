#pragma once
/// Bodies of design/sphere_geometry.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/design/capture_geometry.hpp>
#include <gonio/design/sphere_geometry.hpp>

#include <numeric>

namespace gonio::design {

GONIO_INLINE std::vector<half_difference> sphere_geometry::directions(Eigen::Index slice) const {
  std::vector<half_difference> seen;
  for (const Eigen::Index cell : cells_of(slice)) seen.push_back(cells_.angles(cell));
  return seen;
}

GONIO_INLINE std::optional<Eigen::Index> sphere_geometry::stepped(Eigen::Index from, const grid_step& step) const {
  if (step[0] != 0 || step[2] != 0) return {};
  const Eigen::Index to = from + step[1];
  if (to < 0 || to >= size() || !allows(to)) return {};
  return to;
}

GONIO_INLINE std::vector<Eigen::Index> sphere_geometry::cells_of(Eigen::Index slice) const {
  std::vector<Eigen::Index> found;
  const Eigen::Index layers = cells_.grid().extents().theta_h;
  for (Eigen::Index theta_h = 0; theta_h < layers; ++theta_h) {
    const Eigen::Index row = theta_h * size() + slice;
    for (Eigen::Index cell = cells_.row_begin(row); cell < cells_.row_begin(row + 1); ++cell) found.push_back(cell);
  }
  return found;
}

}  // namespace gonio::design
