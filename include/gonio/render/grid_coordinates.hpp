#pragma once
/// Maps a pair of directions to a MERL-like grid without trigonometric functions, for the inner loop of a renderer. S.
/// Rusinkiewicz, "A New Change of Variables for Efficient BRDF Representation", EGWR 1998
/// (doi:10.1007/978-3-7091-6453-2_2); the grid is from Matusik et al., "A Data-Driven Reflectance Model", SIGGRAPH 2003
/// (doi:10.1145/882262.882343).
///
/// The three angles follow from ratios of sums and differences of the two directions. One polynomial gives their arc
/// tangents; a compiler can evaluate it for several pairs at once.

#include <gonio/core/arc_tangent.hpp>
#include <gonio/table/grid.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>

namespace gonio::render {

/// Relative positions along the axes of a MERL-like grid, from 0 to 1: sqrt(theta_h / (pi / 2)), theta_d / (pi / 2) and
/// phi_d / pi. phi_d is periodic. Multiply by the number of cells to count cells.
template <std::floating_point Real>
struct grid_coordinates {
  Real theta_h = 0;
  Real theta_d = 0;
  Real phi_d = 0;
};

namespace detail {

using gonio::detail::azimuth_terms;
using gonio::detail::half_turns;
using gonio::detail::quarter_turns;

/// Returns the distance of the first node from the beginning of a grid's axis, in cells.
template <std::floating_point Real>
[[nodiscard]] inline Real first_node(const gonio::grid& cells) noexcept {
  return cells.anchor() == cell_anchor::centre ? Real(0.5) : Real(0);
}

/// Returns the nodes nearest to a location. The phi_d node may equal its extent, which stands for node 0.
template <std::floating_point Real>
[[nodiscard]] inline cell_index nearest_nodes(const gonio::grid& cells,
                                              const grid_coordinates<Real>& coordinates) noexcept {
  const auto [heights, rows, columns] = cells.extents();
  const Real shift = Real(0.5) - first_node<Real>(cells);
  const auto node = [shift](Real share, int extent) {
    return static_cast<int>(share * static_cast<Real>(extent) + shift);
  };
  return {std::min(node(coordinates.theta_h, heights), heights - 1),
          std::min(node(coordinates.theta_d, rows), rows - 1), node(coordinates.phi_d, columns)};
}

/// The terms of a pair of directions, before square roots are taken.
template <std::floating_point Real>
struct pair_terms {
  Real squared_h;         ///< tan^2 theta_h, or its inverse where `steep_h` is 1
  Real squared_d;         ///< tan^2 theta_d, or its inverse where `steep_d` is 1
  Real squared_sum;       ///< |wi + wo|^2
  Real along, beside;     ///< tan(phi_d) = beside |wi + wo| / along
  Real steep_h, steep_d;  ///< 1 if theta_h or theta_d is more than pi / 4, otherwise 0

  /// Takes directions above the horizon. Computes both results before it selects one: g++ does not vectorise a loop
  /// that chooses between two computations that may trap.
  pair_terms(Real ix, Real iy, Real iz, Real ox, Real oy, Real oz) noexcept {
    const Real sx = ix + ox, sy = iy + oy, sz = iz + oz, dx = ix - ox, dy = iy - oy, dz = iz - oz;
    const Real across = sx * sx + sy * sy, up = sz * sz, difference = dx * dx + dy * dy + dz * dz;
    squared_sum = across + up;
    steep_h = across > up ? Real(1) : Real(0);
    squared_h = std::min(across, up) / std::max(across, up);
    steep_d = difference > squared_sum ? Real(1) : Real(0);
    squared_d = std::min(difference, squared_sum) / std::max(difference, squared_sum);
    // x and y of the difference vector after the rotation that takes the half vector to the normal, times sqrt(across);
    // x also times |wi + wo|.
    along = sz * (sx * dx + sy * dy) - across * dz;
    beside = sx * dy - sy * dx;
  }
};

}  // namespace detail

/// Returns true if both directions are above the horizon, every component is a number, and the magnitudes of all
/// components sum to at most 1e7.
template <std::floating_point Real>
[[nodiscard]] inline bool is_above_horizon(Real ix, Real iy, Real iz, Real ox, Real oy, Real oz) noexcept {
  const Real sum = std::abs(ix) + std::abs(iy) + std::abs(iz) + std::abs(ox) + std::abs(oy) + std::abs(oz);
  return std::min(iz, oz) > 0 && sum <= Real(1e7);  // false for NaN
}

/// Returns the coordinates of a pair of directions above the horizon. They agree with `to_half_difference` within 4e-7
/// (`float`) or 1e-13 (`double`), except that phi_d is 0 if the half vector is the normal. The directions need not be
/// of unit length, but must have the same length. Four square roots and four divisions.
template <std::floating_point Real>
[[nodiscard]] inline grid_coordinates<Real> to_grid_coordinates(Real ix, Real iy, Real iz, Real ox, Real oy,
                                                                Real oz) noexcept {
  using detail::quarter_turns;
  const detail::pair_terms<Real> pair(ix, iy, iz, ox, oy, oz);
  const detail::azimuth_terms<Real> phi(pair.along, pair.beside * std::sqrt(pair.squared_sum));
  return {std::sqrt(quarter_turns(std::sqrt(pair.squared_h), pair.squared_h, pair.steep_h)),
          quarter_turns(std::sqrt(pair.squared_d), pair.squared_d, pair.steep_d),
          detail::half_turns(quarter_turns(phi.tangent, phi.tangent * phi.tangent, phi.steep), phi.left)};
}

/// Many vectors or colours, as three arrays of equal length: a structure of arrays.
template <class Real>
struct component_arrays {
  std::span<Real> x, y, z;

  [[nodiscard]] Eigen::Index size() const noexcept { return x.size(); }
};

/// Computes the coordinates of several pairs at once. Each step of `to_grid_coordinates` is a loop that compilers
/// vectorise (bench/render/lookup_table.cpp).
template <std::floating_point Real>
class grid_coordinates_block {
 public:
  static constexpr Eigen::Index size = 32;

  /// Computes pairs `first` to `first + count` of the arrays; at most `size`. Coordinates are from 0 to 1 even for
  /// pairs that are not above the horizon.
  void compute(const component_arrays<const Real>& wi, const component_arrays<const Real>& wo, Eigen::Index first,
               Eigen::Index count) noexcept {
    if (count == size) return compute(wi, wo, first);
    // Pad the last few pairs with the normal.
    std::array<lanes, 6> copies;
    const std::array sources{wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
    for (Eigen::Index k = 0; k < std::ssize(copies); ++k) {
      copies[k].fill(k % 3 == 2 ? Real(1) : Real(0));
      std::copy_n(sources[k].begin() + first, count, copies[k].begin());
    }
    compute({copies[0], copies[1], copies[2]}, {copies[3], copies[4], copies[5]}, 0);
  }

  [[nodiscard]] grid_coordinates<Real> operator[](Eigen::Index i) const noexcept {
    return {theta_h_[i], theta_d_[i], phi_d_[i]};
  }

 private:
  using lanes = std::array<Real, size>;

  void compute(const component_arrays<const Real>& wi, const component_arrays<const Real>& wo,
               Eigen::Index first) noexcept {
    const Real *ix = wi.x.data() + first, *iy = wi.y.data() + first, *iz = wi.z.data() + first;
    const Real *ox = wo.x.data() + first, *oy = wo.y.data() + first, *oz = wo.z.data() + first;
    alignas(64) lanes squared_h, squared_d, squared_phi, steep_h, steep_d, steep_phi, along, beside, length, left;
    for (Eigen::Index i = 0; i < size; ++i) {
      const detail::pair_terms<Real> pair(ix[i], iy[i], iz[i], ox[i], oy[i], oz[i]);
      theta_h_[i] = squared_h[i] = pair.squared_h;
      theta_d_[i] = squared_d[i] = pair.squared_d;
      steep_h[i] = pair.steep_h;
      steep_d[i] = pair.steep_d;
      length[i] = pair.squared_sum;
      along[i] = pair.along;
      beside[i] = pair.beside;
    }
    take_roots(theta_h_);
    take_roots(theta_d_);
    take_roots(length);
    for (Eigen::Index i = 0; i < size; ++i) {
      const detail::azimuth_terms<Real> phi(along[i], beside[i] * length[i]);
      phi_d_[i] = phi.tangent;
      squared_phi[i] = phi.tangent * phi.tangent;
      steep_phi[i] = phi.steep;
      left[i] = phi.left;
    }
    to_quarter_turns(theta_h_, squared_h, steep_h);
    take_roots(theta_h_);
    to_quarter_turns(theta_d_, squared_d, steep_d);
    to_quarter_turns(phi_d_, squared_phi, steep_phi);
    for (Eigen::Index i = 0; i < size; ++i) phi_d_[i] = within(detail::half_turns(phi_d_[i], left[i]));
    for (Eigen::Index i = 0; i < size; ++i) theta_h_[i] = within(theta_h_[i]);
    for (Eigen::Index i = 0; i < size; ++i) theta_d_[i] = within(theta_d_[i]);
  }

  static void to_quarter_turns(lanes& tangents, const lanes& squares, const lanes& steep) noexcept {
    for (Eigen::Index i = 0; i < size; ++i) tangents[i] = detail::quarter_turns(tangents[i], squares[i], steep[i]);
  }

  /// Uses Eigen, because a compiled loop would handle negative numbers one by one to set errno.
  static void take_roots(lanes& squares) noexcept {
    Eigen::Map<Eigen::Array<Real, static_cast<int>(size), 1>, Eigen::Aligned64> values(squares.data());
    values = values.sqrt();
  }

  /// Clamps to [0, 1]; 0 for NaN.
  [[nodiscard]] static Real within(Real share) noexcept { return std::min(std::max(Real(0), share), Real(1)); }

  alignas(64) lanes theta_h_{}, theta_d_{}, phi_d_{};
};

}  // namespace gonio::render
