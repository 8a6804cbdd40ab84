#pragma once
/// Numbers the cells of a MERL-like grid such that the cells around a place are found without a look-up and the two
/// along phi_d are neighbours in memory: for the inner loop of a renderer. Rows of phi_d have the last cell again
/// before the first and the first again behind the last, since the axis wraps. The grid is that of Matusik et al., "A
/// Data-Driven Reflectance Model", SIGGRAPH 2003 (doi:10.1145/882262.882343).

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

/// The first of the eight cells around a place, and how far the place is from it to the next along each axis, from 0
/// to 1.
template <std::floating_point Real>
struct cell_corner {
  std::int32_t number = 0;
  Real theta_h = 0, theta_d = 0, phi_d = 0;
};

/// All cells of a grid, those below the horizon too, and two more in each row. Of MERL's grid that is a third more than
/// the cells above the horizon, which `horizon_index` numbers; in return nothing is read to find a cell.
class padded_grid {
 public:
  /// Throws gonio::error if there are 2^31 cells or more.
  explicit padded_grid(const gonio::grid& cells = gonio::grid())
      : grid_(cells),
        columns_(cells.extents().phi_d + 2),
        step_h_(cells.extents().theta_h > 1 ? cells.extents().theta_d * columns_ : 0),
        step_d_(cells.extents().theta_d > 1 ? columns_ : 0) {
    // With the margins, up to three times as many have to be counted.
    constexpr Eigen::Index largest = std::numeric_limits<std::int32_t>::max() / 3;
    if (cells.size() > largest)
      refuse("a grid for rendering has " + std::to_string(cells.size()) + " cells, more than " +
             std::to_string(largest));
  }

  [[nodiscard]] const gonio::grid& grid() const noexcept { return grid_; }
  [[nodiscard]] Eigen::Index size() const noexcept {
    return Eigen::Index{grid_.extents().theta_h} * grid_.extents().theta_d * columns_;
  }
  /// From a cell to the next along theta_h, along theta_d: 0 if there is but one.
  [[nodiscard]] Eigen::Index step_h() const noexcept { return step_h_; }
  [[nodiscard]] Eigen::Index step_d() const noexcept { return step_d_; }

  /// phi_d from -1, which is the last, to its extent, which is the first.
  [[nodiscard]] std::int32_t operator()(Eigen::Index theta_h, Eigen::Index theta_d, Eigen::Index phi_d) const noexcept {
    return static_cast<std::int32_t>((theta_h * grid_.extents().theta_d + theta_d) * columns_ + phi_d + 1);
  }

  /// The number of the cell whose node is nearest to a place.
  template <std::floating_point Real>
  [[nodiscard]] std::int32_t nearest(Real theta_h, Real theta_d, Real phi_d) const noexcept {
    const auto [heights, rows, columns] = grid_.extents();
    const Real shift = Real(0.5) - offset<Real>();
    const int h = std::min(static_cast<int>(theta_h * static_cast<Real>(heights) + shift), heights - 1),
              d = std::min(static_cast<int>(theta_d * static_cast<Real>(rows) + shift), rows - 1),
              p = static_cast<int>(phi_d * static_cast<Real>(columns) + shift);
    return (h * rows + d) * columns_ + p + 1;
  }

  /// The cells around a place. Before the first node of theta_h or theta_d and behind the last their values hold.
  template <std::floating_point Real>
  [[nodiscard]] cell_corner<Real> around(Real theta_h, Real theta_d, Real phi_d) const noexcept {
    const auto [heights, rows, columns] = grid_.extents();
    const auto h = inside(theta_h, heights), d = inside(theta_d, rows);
    const Real p = phi_d * static_cast<Real>(columns) - offset<Real>() + 1;  // counted from the cell before the first
    const int lower_h = lower(h, heights), lower_d = lower(d, rows), lower_p = std::min(static_cast<int>(p), columns);
    return {(lower_h * rows + lower_d) * columns_ + lower_p, h - static_cast<Real>(lower_h),
            d - static_cast<Real>(lower_d), p - static_cast<Real>(lower_p)};
  }

 private:
  template <std::floating_point Real>
  [[nodiscard]] Real inside(Real share, int extent) const noexcept {
    return std::min(std::max(share * static_cast<Real>(extent) - offset<Real>(), Real(0)),
                    static_cast<Real>(extent - 1));
  }

  template <std::floating_point Real>
  [[nodiscard]] static int lower(Real place, int extent) noexcept {
    return std::min(static_cast<int>(place), std::max(extent - 2, 0));
  }

  /// Of the first node from the axis' beginning, in cells.
  template <std::floating_point Real>
  [[nodiscard]] Real offset() const noexcept {
    return grid_.anchor() == cell_anchor::centre ? Real(0.5) : Real(0);
  }

  gonio::grid grid_;
  std::int32_t columns_, step_h_, step_d_;
};

}  // namespace gonio::render
