#pragma once
/// Replaces the thousands of related samples of an image by the few measurements that carry the same information.

#include <gonio/basis/basis.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/table/valid_cells.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace gonio::design {

/// Rows R of a basis at n measurements, n x k, and the response O of each measurement if all samples shift by 1.
struct component_rows {
  Eigen::MatrixXd components;
  Eigen::VectorXd noise;
};

namespace detail {

/// Returns the nearest cells to some directions, ascending, and the number of directions in each.
[[nodiscard]] std::vector<std::pair<Eigen::Index, double>> cells_next_to(std::span<const half_difference> directions,
                                                                         const valid_cells& cells);

}  // namespace detail

/// Returns the rows of the cells nearest to some directions, which must be above the horizon. A cell with c directions
/// becomes one row times sqrt(c), which gives the same normal equations. O(n k).
template <basis Basis>
[[nodiscard]] component_rows rows_at(const Basis& basis, std::span<const half_difference> directions) {
  const std::vector<std::pair<Eigen::Index, double>> counts = detail::cells_next_to(directions, basis.cells());
  const Eigen::Index n = std::ssize(counts), k = basis.size();
  component_rows rows{Eigen::MatrixXd(n, k), Eigen::VectorXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& [cell, count] = counts[i];
    const std::span<const float> row = basis.row(cell);
    const double root = std::sqrt(count);
    for (Eigen::Index j = 0; j < k; ++j) rows.components(i, j) = root * double{row[j]};
    rows.noise[i] = root;
  }
  return rows;
}

/// Returns the shortest matrix Z and vector u with Z'Z = R'R and Z'u = R'O for the given rows (R, O). Ignores
/// eigenvalues of R'R up to `negligible`.
///
/// With R'R = V L V', the result is Z = L^1/2 V' and u = L^-1/2 V'R'O. With a penalty eta, the fraction eta / (eta + L)
/// of the variance along a column of V stays unknown: nearly 1 if L is far below eta. O(n k min(n, k)).
[[nodiscard]] component_rows compressed(const component_rows& rows, double negligible);

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/compressed_rows.ipp>
#endif
