#pragma once
/// Numbers the cells of a MERL-like grid so that the cells around a location are found without a table and neighbours
/// along phi_d are adjacent in memory, for the inner loop of a renderer. Because phi_d is periodic, each row repeats
/// its last cell before the first and its first cell after the last. The grid is from Matusik et al., "A Data-Driven
/// Reflectance Model", SIGGRAPH 2003 (doi:10.1145/882262.882343).

#include <gonio/core/error.hpp>
#include <gonio/render/grid_coordinates.hpp>
#include <gonio/table/grid.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <limits>
#include <string>

namespace gonio::render {

/// The first of the eight cells around a location, and the fraction of the way to the next cell along each axis, from 0
/// to 1.
template <std::floating_point Real>
struct cell_corner {
  std::int32_t number = 0;
  Real theta_h = 0, theta_d = 0, phi_d = 0;
};

/// Numbers all cells of a grid, including those below the horizon, and two more per row. For MERL's grid, these are a
/// third more than the cells above the horizon, which `horizon_index` numbers. In return, finding a cell reads no
/// memory.
class padded_grid {
 public:
  /// Throws gonio::error if there are more than (2^31 - 1) / 3 cells.
  explicit padded_grid(const gonio::grid& cells = gonio::grid())
      : grid_(cells),
        columns_(cells.extents().phi_d + 2),
        step_h_(cells.extents().theta_h > 1 ? cells.extents().theta_d * columns_ : 0),
        step_d_(cells.extents().theta_d > 1 ? columns_ : 0) {
    // With two more cells per row, there are up to three times as many numbers as cells.
    constexpr Eigen::Index largest = std::numeric_limits<std::int32_t>::max() / 3;
    if (cells.size() > largest)
      refuse("a grid for rendering has " + std::to_string(cells.size()) + " cells, more than " +
             std::to_string(largest));
  }

  [[nodiscard]] const gonio::grid& grid() const noexcept { return grid_; }
  [[nodiscard]] Eigen::Index size() const noexcept {
    return Eigen::Index{grid_.extents().theta_h} * grid_.extents().theta_d * columns_;
  }
  /// The offset to the next cell along theta_h and along theta_d; 0 if the axis has only one cell.
  [[nodiscard]] Eigen::Index step_h() const noexcept { return step_h_; }
  [[nodiscard]] Eigen::Index step_d() const noexcept { return step_d_; }

  /// Returns the number of a cell. phi_d may be -1, which stands for the last cell of the row, or the extent of the
  /// axis, which stands for the first.
  [[nodiscard]] std::int32_t operator()(Eigen::Index theta_h, Eigen::Index theta_d, Eigen::Index phi_d) const noexcept {
    return static_cast<std::int32_t>((theta_h * grid_.extents().theta_d + theta_d) * columns_ + phi_d + 1);
  }

  /// Returns the number of the cell whose node is nearest to a location.
  template <std::floating_point Real>
  [[nodiscard]] std::int32_t nearest(const grid_coordinates<Real>& coordinates) const noexcept {
    const auto [theta_h, theta_d, phi_d] = detail::nearest_nodes(grid_, coordinates);
    return (theta_h * grid_.extents().theta_d + theta_d) * columns_ + phi_d + 1;
  }

  /// Returns the cells around a location. theta_h and theta_d are clamped to their first and last nodes.
  template <std::floating_point Real>
  [[nodiscard]] cell_corner<Real> around(const grid_coordinates<Real>& coordinates) const noexcept {
    const auto [heights, rows, columns] = grid_.extents();
    const auto h = inside(coordinates.theta_h, heights), d = inside(coordinates.theta_d, rows);
    const Real p = coordinates.phi_d * static_cast<Real>(columns) - detail::first_node<Real>(grid_) +
                   1;  // 1 for the repeated cell before the first
    const int lower_h = lower(h, heights), lower_d = lower(d, rows), lower_p = std::min(static_cast<int>(p), columns);
    return {(lower_h * rows + lower_d) * columns_ + lower_p, h - static_cast<Real>(lower_h),
            d - static_cast<Real>(lower_d), p - static_cast<Real>(lower_p)};
  }

 private:
  template <std::floating_point Real>
  [[nodiscard]] Real inside(Real share, int extent) const noexcept {
    return std::min(std::max(share * static_cast<Real>(extent) - detail::first_node<Real>(grid_), Real(0)),
                    static_cast<Real>(extent - 1));
  }

  template <std::floating_point Real>
  [[nodiscard]] static int lower(Real position, int extent) noexcept {
    return std::min(static_cast<int>(position), std::max(extent - 2, 0));
  }

  gonio::grid grid_;
  std::int32_t columns_, step_h_, step_d_;
};

}  // namespace gonio::render
