#pragma once
/// Regular grids over (theta_h, theta_d, phi_d) in MERL's layout. theta_d and phi_d are uniform over [0, pi/2] and [0,
/// pi]. theta_h is finer towards the highlight: the node position is proportional to sqrt(theta_h). Matusik et al., "A
/// Data-Driven Reflectance Model", SIGGRAPH 2003 (doi:10.1145/882262.882343).

#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <numbers>
#include <string>
#include <vector>

namespace gonio {

/// Factors from the values of a MERL file to reflectance in sr^-1: red, green and blue.
inline constexpr std::array<double, 3> merl_scale{1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};

/// Cosines up to this size count as the horizon. Whether the cosine of a node on the horizon is 1e-17 or -1e-17 depends
/// on the compiler.
inline constexpr double horizon_cosine = 1e-9;

/// The position in a cell at which its value was taken.
enum class cell_anchor { centre, lower_corner };

/// Index of a cell along each axis.
struct cell_index {
  int theta_h = 0;
  int theta_d = 0;
  int phi_d = 0;

  friend bool operator==(const cell_index&, const cell_index&) = default;
};

/// Number of cells along each axis.
struct grid_extents {
  int theta_h = 90;
  int theta_d = 90;
  int phi_d = 180;

  friend bool operator==(const grid_extents&, const grid_extents&) = default;
};

/// A grid of any extents; the default is MERL's 90 x 90 x 180 with values at cell centres.
///
/// Cells are numbered linearly with phi_d fastest and theta_h slowest, as in MERL's files. A *coordinate* along an axis
/// is a position in units of cells. The node of cell i, the point at which its value was taken, has coordinate i,
/// whether it is the cell's centre or its lower corner.
class grid {
 public:
  /// Throws gonio::error unless every extent is in [1, 4096].
  explicit grid(grid_extents extents = {}, cell_anchor anchor = cell_anchor::centre)
      : extents_(extents), anchor_(anchor) {
    const auto ok = [](int extent) { return extent >= 1 && extent <= 4096; };
    if (!ok(extents.theta_h) || !ok(extents.theta_d) || !ok(extents.phi_d)) refuse_extents(extents);
  }

  [[nodiscard]] const grid_extents& extents() const noexcept { return extents_; }
  [[nodiscard]] cell_anchor anchor() const noexcept { return anchor_; }

  /// Returns the number of cells, valid or not.
  [[nodiscard]] Eigen::Index size() const noexcept {
    return Eigen::Index{extents_.theta_h} * extents_.theta_d * extents_.phi_d;
  }

  [[nodiscard]] Eigen::Index linear(const cell_index& cell) const noexcept {
    return (Eigen::Index{cell.theta_h} * extents_.theta_d + cell.theta_d) * extents_.phi_d + cell.phi_d;
  }

  [[nodiscard]] cell_index cell(Eigen::Index linear) const noexcept {
    const Eigen::Index phi = extents_.phi_d, theta = extents_.theta_d;
    return {static_cast<int>(linear / (phi * theta)), static_cast<int>(linear / phi % theta),
            static_cast<int>(linear % phi)};
  }

  /// Returns theta_h of the node with this coordinate, in radians.
  [[nodiscard]] double theta_h(double coordinate) const noexcept {
    const double fraction = (coordinate + offset()) / extents_.theta_h;
    return fraction * fraction * half_pi;
  }
  [[nodiscard]] double theta_d(double coordinate) const noexcept {
    return (coordinate + offset()) / extents_.theta_d * half_pi;
  }
  [[nodiscard]] double phi_d(double coordinate) const noexcept {
    return (coordinate + offset()) / extents_.phi_d * std::numbers::pi;
  }

  /// Returns the angles at which the value of a cell was taken.
  [[nodiscard]] half_difference angles(const cell_index& cell) const noexcept {
    return {theta_h(cell.theta_h), theta_d(cell.theta_d), phi_d(cell.phi_d)};
  }

  [[nodiscard]] double theta_h_coordinate(double theta_h) const noexcept {
    return extents_.theta_h * std::sqrt(std::max(theta_h, 0.0) / half_pi) - offset();
  }
  [[nodiscard]] double theta_d_coordinate(double theta_d) const noexcept {
    return extents_.theta_d * (theta_d / half_pi) - offset();
  }
  [[nodiscard]] double phi_d_coordinate(double phi_d) const noexcept {
    return extents_.phi_d * (fold_phi_d(phi_d) / std::numbers::pi) - offset();
  }

  /// Returns the cell whose node is nearest in coordinates. Angles outside of the grid go to its border; phi_d wraps.
  [[nodiscard]] cell_index nearest(const half_difference& angles) const noexcept {
    const int phi = static_cast<int>(std::floor(phi_d_coordinate(angles.phi_d) + 0.5));
    return {nearest_node(theta_h_coordinate(angles.theta_h), extents_.theta_h),
            nearest_node(theta_d_coordinate(angles.theta_d), extents_.theta_d), phi % extents_.phi_d};
  }

  friend bool operator==(const grid&, const grid&) = default;

 private:
  static constexpr double half_pi = std::numbers::pi / 2.0;

  [[noreturn]] static void refuse_extents(const grid_extents& extents);

  [[nodiscard]] double offset() const noexcept { return anchor_ == cell_anchor::centre ? 0.5 : 0.0; }
  [[nodiscard]] static int nearest_node(double coordinate, int extent) noexcept {
    return static_cast<int>(std::clamp(std::floor(coordinate + 0.5), 0.0, static_cast<double>(extent - 1)));
  }

  grid_extents extents_;
  cell_anchor anchor_;
};

inline void grid::refuse_extents(const grid_extents& extents) {
  refuse(message_of({"a grid of ", extents.theta_h, " x ", extents.theta_d, " x ", extents.phi_d,
                     " cells: every extent must be from 1 to 4096"}));
}

/// Calls `visit(linear, cosine)` for every cell of a grid in linear order. `cosine` is the smaller of cos theta_i and
/// cos theta_o at the cell's node: sum - |difference cos phi_d| in the terms of `cosines`. This takes a few operations
/// a cell instead of five trigonometric functions.
template <class Visit>
void for_each_smaller_cosine(const grid& cells, Visit&& visit) {
  const auto [heights, rows, columns] = cells.extents();
  std::vector<double> cos_phi;
  for (int k = 0; k < columns; ++k) cos_phi.push_back(std::abs(std::cos(cells.phi_d(k))));
  Eigen::Index linear = 0;
  for (int i = 0; i < heights; ++i) {
    const double cos_h = std::cos(cells.theta_h(i)), sin_h = std::sin(cells.theta_h(i));
    for (int j = 0; j < rows; ++j) {
      const double sum = cos_h * std::cos(cells.theta_d(j)), difference = sin_h * std::sin(cells.theta_d(j));
      for (const double cosine : cos_phi) visit(linear++, sum - difference * cosine);
    }
  }
}

}  // namespace gonio
