#pragma once
/// The cells of a grid at which both directions are above the horizon. Tables and bases store only these.

#include <gonio/core/assertion.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/table/grid.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace gonio {

/// The valid cells of a grid, numbered from 0 in the grid's linear order.
///
/// A cell is valid by geometry alone, never by the sign of its value: both cosines at its node must exceed
/// `minimum_cosine` and `horizon`. (Whether the cosine of a node on the horizon is 1e-17 or -1e-17 depends on the
/// compiler.) A value type; copies share the index, which costs 4 bytes per grid cell and 4 per valid cell.
class valid_cells {
 public:
  /// Cosines up to this size count as the horizon.
  static constexpr double horizon = horizon_cosine;

  /// O(cells of the grid). Throws gonio::error if no cell is valid.
  explicit valid_cells(const gonio::grid& grid = gonio::grid(), double minimum_cosine = 0.0)
      : index_(std::make_shared<const index>(grid, minimum_cosine)) {}

  [[nodiscard]] const gonio::grid& grid() const noexcept { return index_->grid; }
  [[nodiscard]] double minimum_cosine() const noexcept { return index_->minimum_cosine; }

  /// Returns the number of valid cells.
  [[nodiscard]] Eigen::Index size() const noexcept { return index_->linear.size(); }

  /// Returns the linear index in the grid of valid cell number `cell`.
  [[nodiscard]] Eigen::Index linear(Eigen::Index cell) const noexcept {
    GONIO_ASSERT(cell < size());
    return index_->linear[cell];
  }

  [[nodiscard]] half_difference angles(Eigen::Index cell) const noexcept {
    return grid().angles(grid().cell(linear(cell)));
  }

  /// Returns true if the grid cell with this linear index is valid.
  [[nodiscard]] bool contains(Eigen::Index linear) const noexcept {
    return index_->linear[index_->representative[linear]] == linear;
  }

  /// Returns the number of the valid cell that represents a cell of the grid: the cell itself if it is valid, otherwise
  /// the valid cell with the same theta_d and phi_d and the largest theta_h below its own. If there is none, it is the
  /// last valid cell, in linear order, before the cell with the same theta_d and phi_d and the smallest theta_h. This
  /// continues a field below the horizon: interpolation near the horizon reads only valid cells.
  [[nodiscard]] Eigen::Index representative(Eigen::Index linear) const noexcept {
    return index_->representative[linear];
  }

  /// Returns the number of the first valid cell at or after grid row `row`. A row has fixed theta_h and theta_d; rows
  /// are numbered in linear order. The cells of a row end at the first cell of the next row.
  [[nodiscard]] Eigen::Index row_begin(Eigen::Index row) const noexcept { return index_->row_begin[row]; }

  /// Returns the linear index in the grid of a row's first valid cell, if it has one. Equals `linear` of `row_begin`,
  /// from a list that stays in the cache.
  [[nodiscard]] Eigen::Index row_linear(Eigen::Index row) const noexcept { return index_->row_linear[row]; }

  /// Returns true if both describe the same cells of the same grid.
  friend bool operator==(const valid_cells& a, const valid_cells& b) noexcept {
    return a.index_ == b.index_ || (a.grid() == b.grid() && a.index_->linear == b.index_->linear);
  }

 private:
  struct index {
    index(const gonio::grid& cells, double threshold);

    gonio::grid grid;
    double minimum_cosine;
    std::vector<std::uint32_t> linear;
    std::vector<std::uint32_t> representative;
    std::vector<std::uint32_t> row_begin;
    std::vector<std::uint32_t> row_linear;
  };

  std::shared_ptr<const index> index_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/valid_cells.ipp>
#endif
