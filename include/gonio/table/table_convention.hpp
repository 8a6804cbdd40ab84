#pragma once
/// Determines at which position in its cells a table's values were taken. A MERL file does not state it, but the
/// pattern of its cells without a value, -1 in all three planes, reveals it. Matusik et al., "A Data-Driven Reflectance
/// Model", SIGGRAPH 2003 (doi:10.1145/882262.882343).

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

/// The value in all three planes of a cell without a value.
inline constexpr double merl_empty = -1.0;

/// The range of the smaller cosines of marked and unmarked cells, for one anchor.
struct mark_statistics {
  double largest_marked = -std::numeric_limits<double>::infinity();
  double smallest_unmarked = std::numeric_limits<double>::infinity();

  /// Returns how well the anchor explains the marks. 0: not at all. 1: by a threshold, but cells below the horizon are
  /// filled. 2: by a threshold above the horizon. 3: by the horizon itself.
  [[nodiscard]] int rank() const noexcept {
    if (!std::isfinite(smallest_unmarked) || !(largest_marked + horizon_cosine < smallest_unmarked)) return 0;
    if (smallest_unmarked <= 0.0) return 1;
    return largest_marked > 0.0 ? 2 : 3;
  }

  /// Returns the corresponding threshold, never below the horizon.
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
/// An anchor explains the marks if the smaller cosine of every marked cell, at the anchor's node, is below that of
/// every unmarked one. Its minimum cosine is 0, or the middle of the gap if marked cells lie above the horizon. If both
/// anchors explain the marks, an anchor with the horizon in its gap is preferred to one with a gap above it, and that
/// to one with filled cells below the horizon; the centre wins ties. If neither does, as for the files of the MERL
/// database itself, or if nothing is marked, the result is centre and 0. Cells within 1e-9 of the horizon are ignored.
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
