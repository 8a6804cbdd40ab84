#pragma once
/// A location at which a field over the valid cells of a grid is read: a single cell, or the corners of the box around
/// a direction pair, with their trilinear weights.

#include <gonio/table/valid_cells.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace gonio {

/// The cells from which a field is read: at most eight valid cells with weights that sum to 1. Also has the exact
/// angles and cosines of the location, which metrics need and interpolation would blur.
struct location {
  std::array<std::uint32_t, 8> cell{};
  std::array<double, 8> weight{};
  int count = 0;
  half_difference angles;
  cosine_pair cosine;

  /// Returns true if both directions are above the horizon.
  [[nodiscard]] bool above_horizon() const noexcept { return cosine.i > 0.0 && cosine.o > 0.0; }
};

/// Returns the location that reads a single cell. The location has no angles, because a domain may have none.
[[nodiscard]] inline location location_of(Eigen::Index cell) noexcept {
  location at;
  at.cell[0] = static_cast<std::uint32_t>(cell);
  at.weight[0] = 1.0;
  at.count = 1;
  return at;
}

/// Returns the location of a cell's own node.
[[nodiscard]] inline location locate_cell(const valid_cells& cells, Eigen::Index cell) noexcept {
  location at = location_of(cell);
  at.angles = cells.angles(cell);
  at.cosine = cosines(at.angles);
  return at;
}

namespace detail {

/// The two nodes of an axis around a coordinate, and their weights.
struct axis_interval {
  std::array<int, 2> node;
  std::array<double, 2> weight;
};

/// Returns the node at or below a coordinate, and the distance from it. A coordinate within 1e-9 of a node counts as
/// that node. Otherwise a node computed from an angle would read a neighbour with a weight of 1e-15.
[[nodiscard]] inline std::pair<int, double> split_coordinate(double coordinate) noexcept {
  constexpr double snap = 1e-9;
  const double node = std::floor(coordinate + snap);
  const double fraction = coordinate - node;
  return {static_cast<int>(node), fraction < snap ? 0.0 : fraction};
}

/// Returns the interval on an axis that does not wrap. Outside of the axis, the first or the last node has all of the
/// weight.
[[nodiscard]] inline axis_interval clamped_interval(double coordinate, int extent) noexcept {
  const auto [node, fraction] = split_coordinate(std::clamp(coordinate, 0.0, static_cast<double>(extent - 1)));
  return {{node, std::min(node + 1, extent - 1)}, {1.0 - fraction, fraction}};
}

/// Returns the interval on an axis that wraps.
[[nodiscard]] inline axis_interval periodic_interval(double coordinate, int extent) noexcept {
  const auto [node, fraction] = split_coordinate(coordinate);
  return {{(node + extent) % extent, (node + 1) % extent}, {1.0 - fraction, fraction}};
}

}  // namespace detail

/// Interpolates trilinearly in the grid's own coordinates. theta_h and theta_d are clamped to the first and last node;
/// phi_d wraps (reciprocity). A corner below the horizon is replaced by its representative: only valid cells are read.
/// Corners of weight zero are left out.
[[nodiscard]] inline location locate(const valid_cells& cells, const half_difference& angles) noexcept {
  const grid& over = cells.grid();
  const grid_extents extents = over.extents();
  const auto h = detail::clamped_interval(over.theta_h_coordinate(angles.theta_h), extents.theta_h);
  const auto d = detail::clamped_interval(over.theta_d_coordinate(angles.theta_d), extents.theta_d);
  const auto p = detail::periodic_interval(over.phi_d_coordinate(angles.phi_d), extents.phi_d);

  location at;
  at.angles = angles;
  at.cosine = cosines(angles);
  for (Eigen::Index corner = 0; corner < 8; ++corner) {
    const Eigen::Index a = corner >> 2, b = corner >> 1 & 1, c = corner & 1;
    const double weight = h.weight[a] * d.weight[b] * p.weight[c];
    if (weight == 0.0) continue;
    const Eigen::Index linear = over.linear({h.node[a], d.node[b], p.node[c]});
    const Eigen::Index slot = at.count++;
    at.cell[slot] = static_cast<std::uint32_t>(cells.representative(linear));
    at.weight[slot] = weight;
  }
  return at;
}

/// Returns the weighted mean of `value(cell)` over a location's cells; `zero` starts the sum.
template <class Value, class Zero>
[[nodiscard]] Zero interpolate(const location& at, Value&& value, Zero zero) {
  for (int corner = 0; corner < at.count; ++corner) {
    zero += at.weight[corner] * value(Eigen::Index{at.cell[corner]});
  }
  return zero;
}

}  // namespace gonio
