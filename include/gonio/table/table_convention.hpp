#pragma once
/// Determines the position in its cells at which a table's values were taken. A MERL file does not state this position,
/// but the pattern of the file's empty cells, -1 in all three planes, reveals it. Matusik et al., "A Data-Driven
/// Reflectance Model", SIGGRAPH 2003 (doi:10.1145/882262.882343).

#include <gonio/core/error.hpp>
#include <gonio/table/grid.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

namespace gonio {

/// The position in its cells at which a table's values were taken, and the smallest cosine of a cell with a value.
struct table_convention {
  cell_anchor anchor = cell_anchor::centre;
  double minimum_cosine = 0.0;

  friend bool operator==(const table_convention&, const table_convention&) = default;
};

namespace detail {

/// The number in all three planes of a MERL file that marks a cell as empty.
inline constexpr double merl_empty = -1.0;

/// For one anchor, the largest cosine of the marked (empty) cells and the smallest of the unmarked ones. A cell's
/// cosine is the smaller cosine of its two directions.
struct mark_statistics {
  double largest_marked = -std::numeric_limits<double>::infinity();
  double smallest_unmarked = std::numeric_limits<double>::infinity();

  /// Returns how well the anchor explains which cells are marked. 0: no threshold of the cosine separates marked from
  /// unmarked cells. 1: a threshold does, but unmarked cells lie below the horizon. 2: a threshold above the horizon
  /// does. 3: the horizon itself does.
  [[nodiscard]] int rank() const noexcept {
    if (!std::isfinite(smallest_unmarked) || !(largest_marked + horizon_cosine < smallest_unmarked)) return 0;
    if (smallest_unmarked <= 0.0) return 1;
    return largest_marked > 0.0 ? 2 : 3;
  }

  /// Returns the threshold of the cosine if `rank` is 2, otherwise 0 (the horizon).
  [[nodiscard]] double minimum_cosine() const noexcept {
    return rank() == 2 ? 0.5 * (largest_marked + smallest_unmarked) : 0.0;
  }
};

template <std::predicate<std::size_t> Marked>
[[nodiscard]] mark_statistics sort_marks(const grid& cells, const Marked& marked) {
  mark_statistics found;
  for_each_smaller_cosine(cells, [&](std::size_t linear, double cosine) {
    if (std::abs(cosine) <= horizon_cosine) return;
    if (marked(linear))
      found.largest_marked = std::max(found.largest_marked, cosine);
    else
      found.smallest_unmarked = std::min(found.smallest_unmarked, cosine);
  });
  return found;
}

}  // namespace detail

/// Infers the convention of a table from the cells that are marked as empty.
///
/// An anchor explains the marks if, at the anchor's nodes, the smaller cosine of every marked cell is below the smaller
/// cosine of every unmarked cell. The anchor's minimum cosine is 0 or, if marked cells lie above the horizon, the
/// middle of the gap between the cosines of marked and unmarked cells. If both anchors explain the marks, the first of
/// these cases decides: the horizon is in the gap; the gap is above the horizon; cells below the horizon are filled.
/// The centre wins ties. If no anchor explains the marks, as in the files of the MERL database itself, or if nothing is
/// marked, the result is centre and 0. Cells within 1e-9 of the horizon are ignored.
template <std::predicate<std::size_t> Marked>
[[nodiscard]] table_convention infer_convention(const grid_extents& extents, const Marked& marked) {
  const detail::mark_statistics centre = detail::sort_marks(grid(extents, cell_anchor::centre), marked);
  const detail::mark_statistics corner = detail::sort_marks(grid(extents, cell_anchor::lower_corner), marked);
  if (corner.rank() > centre.rank()) return {cell_anchor::lower_corner, corner.minimum_cosine()};
  return {cell_anchor::centre, centre.minimum_cosine()};
}

/// Infers the convention from the three planes after a MERL file's header. Throws gonio::error if they do not have the
/// size of the grid.
[[nodiscard]] inline table_convention infer_convention(std::span<const double> planes, const grid_extents& extents) {
  const Eigen::Index plane = grid(extents).size();
  if (std::ssize(planes) != 3 * plane)
    refuse(message_of({"a MERL table needs three planes of ", plane, " values, not ", planes.size(), " values"}));
  return infer_convention(extents, [&](std::size_t linear) {
    return planes[linear] == detail::merl_empty && planes[plane + linear] == detail::merl_empty &&
           planes[2 * plane + linear] == detail::merl_empty;
  });
}

}  // namespace gonio
