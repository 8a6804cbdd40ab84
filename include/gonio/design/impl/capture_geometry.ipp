#pragma once
/// Bodies of design/capture_geometry.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/design/capture_constraint.hpp>
#include <gonio/design/capture_geometry.hpp>
#include <gonio/table/valid_cells.hpp>

#include <array>
#include <concepts>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gonio::design {

GONIO_INLINE point_geometry::point_geometry(valid_cells cells, capture_constraint constraint)
    : cells_(std::move(cells)), constraint_(std::move(constraint)) {
  for (const direction_pair& pair : constraint_.pairs)
    if (constraint_(pair)) fixed_pairs_.emplace(nearest(pair), pair);
}

GONIO_INLINE bool point_geometry::allows(Eigen::Index cell) const {
  if (constraint_.is_none()) return true;
  if (!constraint_.pairs.empty()) return fixed_pairs_.contains(cell);
  if (constraint_.plane_tolerance && cells_.grid().cell(cells_.linear(cell)).phi_d != 0) return false;
  return constraint_.pose_of(cells_.angles(cell)).has_value();
}

GONIO_INLINE std::string point_geometry::excluding_rule() const {
  return constraint_.excluding_rule([&](const capture_constraint& some) {
    const point_geometry with(cells_, some);
    for (Eigen::Index cell = 0; cell < with.size(); ++cell)
      if (with.allows(cell)) return true;
    return false;
  });
}

GONIO_INLINE direction_pair point_geometry::centre(Eigen::Index cell) const {
  if (const auto fixed = fixed_pairs_.find(cell); fixed != fixed_pairs_.end()) return fixed->second;
  const half_difference angles = cells_.angles(cell);
  return constraint_.pose_of(angles).value_or(to_directions(angles));
}

GONIO_INLINE Eigen::Index point_geometry::nearest(const direction_pair& pair) const {
  const grid& grid = cells_.grid();
  return cells_.representative(grid.linear(grid.nearest(to_half_difference(pair.wi, pair.wo))));
}

GONIO_INLINE std::optional<Eigen::Index> point_geometry::stepped(Eigen::Index from, const grid_step& step) const {
  const grid& grid = cells_.grid();
  const grid_extents& extents = grid.extents();
  const cell_index at = grid.cell(cells_.linear(from));
  const int theta_h = at.theta_h + step[0], theta_d = at.theta_d + step[1];
  if (theta_h < 0 || theta_h >= extents.theta_h || theta_d < 0 || theta_d >= extents.theta_d) return {};
  const int phi_d = ((at.phi_d + step[2]) % extents.phi_d + extents.phi_d) % extents.phi_d;
  const Eigen::Index linear = grid.linear({theta_h, theta_d, phi_d});
  if (!cells_.contains(linear)) return {};
  const Eigen::Index cell = cells_.representative(linear);
  if (!allows(cell)) return {};
  return cell;
}

}  // namespace gonio::design
