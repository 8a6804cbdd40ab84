#pragma once
/// The measurements that one setting of an apparatus gives: one for a goniometer, thousands for an image.
/// `capture_geometry` is the concept and `point_geometry` its simplest model. The other models are in
/// `sphere_geometry.hpp` and `near_field_geometry.hpp`.

#include <gonio/design/capture_constraint.hpp>
#include <gonio/table/valid_cells.hpp>

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gonio::design {

/// A step on a grid of candidates: the number of positions along each axis.
using grid_step = std::array<int, 3>;

/// Candidates for a measurement, numbered from 0 to size() - 1.
///
/// - `allows(candidate)`: true if the candidate can be measured. The other functions require an allowed candidate.
/// - `centre(candidate)`: the directions of light and viewer; for an image, the directions at its centre.
/// - `nearest(pair)`: the candidate whose centre is nearest to a pair of directions above the horizon.
/// - `directions(candidate)`: the directions of all samples of the candidate; at least one.
/// - `stepped(candidate, step)`: the candidate one step away on the grid, if it exists and is allowed. The opposite
///   step leads back if both exist.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/design/capture_geometry.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::design::point_geometry points{gonio::valid_cells()};
///   const Eigen::Index candidate = points.nearest({{0, 0, 1}, {0, 0, 1}});
///   std::printf("candidate %td of %td\n", candidate, points.size());
/// }
/// ```
/// With a model of your own, ten lamps above a camera at the normal:
/// ```cpp
/// #include <gonio/design/capture_geometry.hpp>
///
/// #include <cmath>
///
/// struct row_of_lamps {
///   Eigen::Index size() const { return 10; }
///   bool allows(Eigen::Index) const { return true; }
///   gonio::direction_pair centre(Eigen::Index lamp) const {
///     const double theta = 0.1 * static_cast<double>(lamp + 1);
///     return {{std::sin(theta), 0, std::cos(theta)}, {0, 0, 1}};
///   }
///   Eigen::Index nearest(const gonio::direction_pair& pair) const {
///     const double theta = std::acos(std::clamp(pair.wi.z(), -1.0, 1.0));
///     return static_cast<Eigen::Index>(std::clamp(std::round(10 * theta) - 1, 0.0, 9.0));
///   }
///   std::vector<gonio::half_difference> directions(Eigen::Index lamp) const {
///     return {gonio::to_half_difference(centre(lamp).wi, centre(lamp).wo)};
///   }
///   std::optional<Eigen::Index> stepped(Eigen::Index lamp, const gonio::design::grid_step& step) const {
///     const int to = static_cast<int>(lamp) + step[0];
///     if (to < 0 || to > 9 || step[1] != 0 || step[2] != 0) return {};
///     return to;
///   }
/// };
/// static_assert(gonio::design::capture_geometry<row_of_lamps>);
///
/// int main() { return row_of_lamps{}.nearest({{0, 0, 1}, {0, 0, 1}}) == 0 ? 0 : 1; }
/// ```
template <class Geometry>
concept capture_geometry = requires(const Geometry& geometry, Eigen::Index candidate, const grid_step& step,
                                    const direction_pair& pair) {
  { geometry.size() } -> std::convertible_to<Eigen::Index>;
  { geometry.allows(candidate) } -> std::convertible_to<bool>;
  { geometry.centre(candidate) } -> std::convertible_to<direction_pair>;
  { geometry.nearest(pair) } -> std::convertible_to<Eigen::Index>;
  { geometry.directions(candidate) } -> std::convertible_to<std::vector<half_difference>>;
  { geometry.stepped(candidate, step) } -> std::convertible_to<std::optional<Eigen::Index>>;
};

/// Every valid cell of a grid is a candidate, with a single sample. If the constraint allows a cell's pair of
/// directions only with light and viewer exchanged, they are exchanged. phi_d is periodic.
class point_geometry {
 public:
  /// If the constraint lists fixed pairs, only the cells that contain them are allowed. If a cell contains several
  /// pairs, the first is used.
  explicit point_geometry(valid_cells cells, capture_constraint constraint = {});

  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] Eigen::Index size() const noexcept { return cells_.size(); }
  /// If `plane_tolerance` is set, only cells with the first phi_d are allowed, because phi_d becomes 0 and other cells
  /// would repeat the same pose.
  [[nodiscard]] bool allows(Eigen::Index cell) const;
  /// Returns the rule that leaves no candidate; empty if there is a candidate. O(cells).
  [[nodiscard]] std::string excluding_rule() const;
  [[nodiscard]] direction_pair centre(Eigen::Index cell) const;
  [[nodiscard]] Eigen::Index nearest(const direction_pair& pair) const;
  [[nodiscard]] std::vector<half_difference> directions(Eigen::Index cell) const { return {cells_.angles(cell)}; }

  [[nodiscard]] std::optional<Eigen::Index> stepped(Eigen::Index from, const grid_step& step) const;

 private:
  valid_cells cells_;
  capture_constraint constraint_;
  std::map<Eigen::Index, direction_pair> fixed_pairs_;  ///< keys are cells
};
static_assert(capture_geometry<point_geometry>);

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/capture_geometry.ipp>
#endif
