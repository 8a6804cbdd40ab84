#pragma once
/// Numbers the cells of a MERL-like grid above the horizon, for the inner loop of a renderer. It replaces the 10 MB of
/// `valid_cells` by 100 KB, which stay in the processor's cache.

#include <gonio/render/grid_coordinates.hpp>
#include <gonio/table/grid.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <vector>

namespace gonio::render {

/// The eight cells around a location, with weights that sum to 1.
template <std::floating_point Real>
struct trilinear_corners {
  std::array<Eigen::Index, 8> number{};
  std::array<Real, 8> weight{};
};

namespace detail {

/// The two nodes of an axis around a position, and the fraction of the way from the lower to the upper.
template <std::floating_point Real>
struct node_interval {
  Eigen::Index lower, upper;
  Real share;
};

/// Returns the nodes around a position, in units of nodes. Positions outside of the axis are clamped to the first or
/// last node.
template <std::floating_point Real>
[[nodiscard]] inline node_interval<Real> clamped_nodes(Real position, int extent) noexcept {
  const Real inside = std::clamp(position, Real(0), static_cast<Real>(extent - 1));
  const auto lower = static_cast<int>(inside);
  return {lower, std::min(lower + 1, extent - 1), inside - static_cast<Real>(lower)};
}

/// Returns the nodes of a periodic axis around a position, which is from -1/2 to the extent of the axis.
template <std::floating_point Real>
[[nodiscard]] inline node_interval<Real> periodic_nodes(Real position, int extent) noexcept {
  const auto upper = static_cast<int>(position + 1);
  const Real share = position + 1 - static_cast<Real>(upper);
  if (upper == 0) return {extent - 1, 0, share};
  const Eigen::Index lower = upper > extent ? 0 : upper - 1;
  return {lower, lower + 1 < extent ? lower + 1 : 0, share};
}

}  // namespace detail

/// The cells at whose node both directions are above the horizon, numbered in the grid's linear order like
/// `valid_cells`.
///
/// For a given theta_d and phi_d, these cells range from theta_h = 0 to some largest theta_h. For a given theta_h and
/// theta_d they are contiguous in phi_d, so a cell's number is the offset of its row plus its phi_d.
class horizon_index {
 public:
  /// O(cells of the grid). Throws gonio::error if, at some theta_d and phi_d, no cell is above the horizon. That can
  /// only happen with more cells along theta_d than twice the square of the number along theta_h.
  explicit horizon_index(const gonio::grid& cells = gonio::grid());

  /// Returns the number of cells above the horizon.
  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }
  [[nodiscard]] const gonio::grid& grid() const noexcept { return grid_; }

  /// Returns the number of a cell. For a cell below the horizon, returns the number of the cell above the horizon with
  /// the same theta_d and phi_d and the largest theta_h. Look-ups near the horizon then find no hole.
  [[nodiscard]] Eigen::Index operator()(Eigen::Index theta_h, Eigen::Index theta_d, Eigen::Index phi_d) const noexcept {
    const Eigen::Index layer = std::min<Eigen::Index>(theta_h, last_[theta_d * columns_ + phi_d]);
    return begin_[layer * rows_ + theta_d] + static_cast<std::uint32_t>(phi_d);  // modulo 2^32
  }

  /// Returns the number among all cells of the grid (`grid::linear`) of the cell that `operator()` numbers.
  [[nodiscard]] Eigen::Index linear(Eigen::Index theta_h, Eigen::Index theta_d, Eigen::Index phi_d) const noexcept {
    const Eigen::Index layer = std::min<Eigen::Index>(theta_h, last_[theta_d * columns_ + phi_d]);
    return (layer * rows_ + theta_d) * columns_ + phi_d;
  }

  /// Returns the number of the cell whose node is nearest to a location.
  template <std::floating_point Real>
  [[nodiscard]] Eigen::Index nearest(const grid_coordinates<Real>& coordinates) const noexcept {
    const auto [theta_h, theta_d, phi_d] = detail::nearest_nodes(grid_, coordinates);
    return (*this)(theta_h, theta_d, phi_d < columns_ ? phi_d : 0);
  }

  /// Returns the cells around a location. theta_h and theta_d are clamped to their first and last nodes; phi_d is
  /// periodic.
  template <std::floating_point Real>
  [[nodiscard]] trilinear_corners<Real> around(const grid_coordinates<Real>& coordinates) const noexcept {
    return around(coordinates, *this);
  }

  /// Returns the cells around a location as the overload without `number_of` does, but with the numbers that
  /// `number_of(theta_h, theta_d, phi_d)` returns.
  template <std::floating_point Real, class NumberOf>
  [[nodiscard]] trilinear_corners<Real> around(const grid_coordinates<Real>& coordinates,
                                               const NumberOf& number_of) const noexcept {
    const auto [heights, rows, columns] = grid_.extents();
    const auto nodes = [this](Real coordinate, int extent) {
      return coordinate * static_cast<Real>(extent) - detail::first_node<Real>(grid_);
    };
    const auto h = detail::clamped_nodes(nodes(coordinates.theta_h, heights), heights),
               d = detail::clamped_nodes(nodes(coordinates.theta_d, rows), rows),
               p = detail::periodic_nodes(nodes(coordinates.phi_d, columns), columns);
    trilinear_corners<Real> corners;
    for (Eigen::Index k = 0; k < 8; ++k) {
      const bool is_upper_h = (k & 4) != 0, is_upper_d = (k & 2) != 0, is_upper_p = (k & 1) != 0;
      corners.number[k] =
          number_of(is_upper_h ? h.upper : h.lower, is_upper_d ? d.upper : d.lower, is_upper_p ? p.upper : p.lower);
      corners.weight[k] = (is_upper_h ? h.share : 1 - h.share) * (is_upper_d ? d.share : 1 - d.share) *
                          (is_upper_p ? p.share : 1 - p.share);
    }
    return corners;
  }

  /// Returns the memory in bytes.
  [[nodiscard]] Eigen::Index memory() const noexcept {
    return begin_.size() * sizeof(std::uint32_t) + last_.size() * sizeof(std::uint16_t);
  }

 private:
  static constexpr std::uint16_t none = UINT16_MAX;

  [[nodiscard]] std::string sentence(Eigen::Index column) const;

  gonio::grid grid_;
  Eigen::Index rows_, columns_;
  std::vector<std::uint32_t> begin_;  ///< by theta_h and theta_d: the number of the first cell minus its phi_d
  std::vector<std::uint16_t> last_;   ///< by theta_d and phi_d: the largest theta_h above the horizon
  std::uint32_t size_ = 0;
  Eigen::Index row_of_last_ = -1;
};

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/horizon_index.ipp>
#endif
