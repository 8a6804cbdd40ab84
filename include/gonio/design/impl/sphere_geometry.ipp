#pragma once
/// Bodies of design/sphere_geometry.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/design/capture_geometry.hpp>
#include <gonio/design/sphere_geometry.hpp>

#include <numeric>

namespace gonio::design {

GONIO_INLINE std::vector<half_difference> sphere_geometry::directions(std::size_t slice) const {
  std::vector<half_difference> seen;
  for (const std::size_t cell : cells_of(slice)) seen.push_back(cells_.angles(cell));
  return seen;
}

GONIO_INLINE std::optional<std::size_t> sphere_geometry::stepped(std::size_t from, const grid_step& step) const {
  if (step[0] != 0 || step[2] != 0) return {};
  const auto slice = static_cast<std::ptrdiff_t>(from) + step[1];
  if (slice < 0 || slice >= std::ssize(*this)) return {};
  const auto to = static_cast<std::size_t>(slice);
  if (!allows(to)) return {};
  return to;
}

GONIO_INLINE std::vector<std::size_t> sphere_geometry::cells_of(std::size_t slice) const {
  std::vector<std::size_t> found;
  const auto layers = static_cast<std::size_t>(cells_.grid().extents().theta_h);
  for (std::size_t theta_h = 0; theta_h < layers; ++theta_h) {
    const std::size_t row = theta_h * size() + slice;
    for (std::size_t cell = cells_.row_begin(row); cell < cells_.row_begin(row + 1); ++cell) found.push_back(cell);
  }
  return found;
}

}  // namespace gonio::design
