#pragma once
/// Bodies of render/horizon_index.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/render/grid_coordinates.hpp>
#include <gonio/render/horizon_index.hpp>
#include <gonio/table/grid.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <vector>

namespace gonio::render {

GONIO_INLINE horizon_index::horizon_index(const gonio::grid& cells)
    : grid_(cells), rows_(cells.extents().theta_d), columns_(cells.extents().phi_d) {
  last_.assign(rows_ * columns_, none);
  begin_.reserve(cells.extents().theta_h * rows_);
  for_each_smaller_cosine(cells, [&](Eigen::Index cell, double cosine) {
    const Eigen::Index phi = cell % columns_, row = cell / columns_;
    if (phi == 0) begin_.push_back(size_);
    if (!(cosine > horizon_cosine)) return;
    if (row_of_last_ != row) begin_.back() = size_ - static_cast<std::uint32_t>(phi);
    row_of_last_ = row;
    last_[row % rows_ * columns_ + phi] = static_cast<std::uint16_t>(row / rows_);
    ++size_;
  });
  const auto empty = std::ranges::find(last_, none);
  if (empty != last_.end()) refuse(sentence(empty - last_.begin()));
}

GONIO_INLINE std::string horizon_index::sentence(Eigen::Index column) const {
  const auto [theta_h, theta_d, phi_d] = grid_.extents();
  return "a grid of " + std::to_string(theta_h) + " x " + std::to_string(theta_d) + " x " + std::to_string(phi_d) +
         " cells has none above the horizon at theta_d number " + std::to_string(column / columns_) +
         ", phi_d number " + std::to_string(column % columns_) + ": it needs more cells along theta_h";
}

}  // namespace gonio::render
