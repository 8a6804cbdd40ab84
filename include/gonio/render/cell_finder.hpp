#pragma once
/// Finds the cell of a MERL-like grid that contains a pair of directions, without trigonometric functions, for the
/// inner loop of a renderer. S. Rusinkiewicz, "A New Change of Variables for Efficient BRDF Representation", EGWR 1998
/// (doi:10.1007/978-3-7091-6453-2_2); the grid is from Matusik et al., "A Data-Driven Reflectance Model", SIGGRAPH 2003
/// (doi:10.1145/882262.882343).
///
/// An angle from 0 to 90 degrees is identified by s / (s + c) with its sine s and cosine c. This ratio rises almost
/// evenly from 0 to 1 and does not change if s and c have a common factor. The ratios at the cells' borders are
/// tabulated once.

#include <gonio/table/grid.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace gonio::render {

namespace detail {

/// Counts the borders, in ascending order, that are not above a number. A table over the range gives the count up to
/// one border, and one comparison completes it.
template <std::floating_point Real>
class border_counter {
 public:
  border_counter() = default;

  /// Takes borders from 0 up to `end`.
  border_counter(const std::vector<double>& borders, double end) : borders_(borders.begin(), borders.end()) {
    borders_.push_back(static_cast<Real>(2.0 * end));  // never reached
    Eigen::Index bins = 64;
    while (!fill(bins, static_cast<Real>(end))) bins *= 2;
  }

  /// Returns the count for a number from 0 to `end`.
  [[nodiscard]] Eigen::Index operator()(Real number) const noexcept {
    const Eigen::Index before = before_[static_cast<Eigen::Index>(number * bins_per_unit_)];
    return before + (number >= borders_[before] ? 1u : 0u);
  }

 private:
  /// Fills the table. Returns false if a bin has two borders.
  bool fill(Eigen::Index bins, Real end) {
    bins_per_unit_ = static_cast<Real>(bins) / end;
    before_.assign(bins + 1, 0);  // the last bin is for `end` itself
    std::vector<int> in_bin(bins + 1, 0);
    for (Eigen::Index i = 0; i + 1 < std::ssize(borders_); ++i)
      ++in_bin[static_cast<Eigen::Index>(borders_[i] * bins_per_unit_)];
    if (std::ranges::any_of(in_bin, [](int count) { return count > 1; })) return false;
    for (Eigen::Index bin = 1; bin <= bins; ++bin)
      before_[bin] = static_cast<std::uint16_t>(before_[bin - 1] + in_bin[bin - 1]);
    return true;
  }

  std::vector<Real> borders_;
  std::vector<std::uint16_t> before_;
  Real bins_per_unit_ = 1;
};

}  // namespace detail

/// Finds the same cells as `grid::nearest`, which uses arc functions, in a fraction of the time. Use it for one pair at
/// a time. For many pairs at once, or locations between cells, use `to_grid_coordinates`. For single pairs,
/// `to_grid_coordinates` is slower, because its polynomials have more instructions than a processor can look ahead
/// (bench/render/lookup_table.cpp). In `float`, rounding may give the neighbouring cell within 1e-6 radians of a
/// border, which happens to some pairs in a million. In `double`, ten million pairs gave no other cell. The two
/// directions need not be of unit length, but must have the same length.
///
/// Construction allocates some kilobytes. After that it does not allocate, lock or throw, and may be used from many
/// threads.
template <std::floating_point Real = float>
class cell_finder {
 public:
  /// O(theta_h + theta_d + phi_d).
  explicit cell_finder(const grid& cells = grid()) : rows_(cells.extents().theta_d), columns_(cells.extents().phi_d) {
    const auto [theta_h, theta_d, phi_d] = cells.extents();
    // The border before node k is half a cell from the node. On the theta_h axis, that border is not midway between the
    // angles of two nodes.
    const double shift = cells.anchor() == cell_anchor::centre ? 0.0 : -0.5;
    constexpr double half_pi = std::numbers::pi / 2.0;
    std::vector<double> h, d, phi;
    for (int k = 1; k < theta_h; ++k) {
      const double fraction = (k + shift) / theta_h;
      h.push_back(std::sqrt(share(half_pi * fraction * fraction)));
    }
    for (int k = 1; k < theta_d; ++k) d.push_back(share(half_pi * (k + shift) / theta_d));
    // After the last node of the periodic axis there may be a border between it and the first node.
    for (int k = 1; k + shift < phi_d; ++k) {
      const double angle = std::numbers::pi * (k + shift) / phi_d;
      phi.push_back(angle < half_pi ? share(angle) : 1.0 + share(angle - half_pi));
    }
    theta_h_ = {h, 1.0};
    theta_d_ = {d, 1.0};
    phi_d_ = {phi, 2.0};
  }

  /// The number that stands for no cell.
  static constexpr Eigen::Index none = std::numeric_limits<Eigen::Index>::max();

  /// The cell of a pair, and whether it exists.
  struct found_cell {
    Eigen::Index theta_h = 0, theta_d = 0, phi_d = 0;
    bool exists = false;
  };

  /// Returns the linear number of the cell, phi_d fastest and theta_h slowest. Returns `none` if a direction is at or
  /// below the horizon, or not finite. Directions are any type with components `[0]`, `[1]`, `[2]`.
  template <class Direction>
  [[nodiscard]] Eigen::Index operator()(const Direction& wi, const Direction& wo) const noexcept {
    return at(wi[0], wi[1], wi[2], wo[0], wo[1], wo[2]);
  }

  [[nodiscard]] Eigen::Index at(Real ix, Real iy, Real iz, Real ox, Real oy, Real oz) const noexcept {
    const found_cell cell = find(ix, iy, iz, ox, oy, oz);
    return cell.exists ? (cell.theta_h * rows_ + cell.theta_d) * columns_ + cell.phi_d : none;
  }

  [[nodiscard]] found_cell find(Real ix, Real iy, Real iz, Real ox, Real oy, Real oz) const noexcept {
    const Real sx = ix + ox, sy = iy + oy, sz = iz + oz, dx = ix - ox, dy = iy - oy, dz = iz - oz;
    const Real across = sx * sx + sy * sy, sum = across + sz * sz, difference = dx * dx + dy * dy + dz * dz;
    // The condition is also false for NaN.
    if (!(iz > 0 && oz > 0 && sum + difference <= largest)) return {};
    const Real length = std::sqrt(sum), radius = std::sqrt(across), apart = std::sqrt(difference);
    // The difference vector after the rotation that takes the half vector to the normal, times the radius. If the half
    // vector is the normal, the difference vector is not rotated.
    const bool on_axis = !(across > 0);
    const Real along = sx * dx + sy * dy;
    const Real x = on_axis ? dx : (sz * along - across * dz) / length, y = on_axis ? dy : sx * dy - sy * dx;
    const Eigen::Index phi = phi_d_(half_turn_share(x, y));
    return {theta_h_(std::sqrt(radius / (radius + sz))), theta_d_(apart / (apart + length)), phi < columns_ ? phi : 0,
            true};
  }

 private:
  static constexpr Real largest = static_cast<Real>(1e30);

  [[nodiscard]] static double share(double angle) {
    const double s = std::sin(angle), c = std::cos(angle);
    return s / (s + c);
  }

  /// Maps an azimuth modulo pi to [0, 2).
  [[nodiscard]] static Real half_turn_share(Real x, Real y) noexcept {
    const bool is_below = y < 0;
    const Real up = is_below ? -y : y, right = is_below ? -x : x, side = std::abs(x);
    const Real total = side + up;
    if (!(total > 0) || !(up > 0)) return 0;
    return right >= 0 ? up / total : 1 + side / total;
  }

  Eigen::Index rows_, columns_;
  detail::border_counter<Real> theta_h_, theta_d_, phi_d_;
};

}  // namespace gonio::render
