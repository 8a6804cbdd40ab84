#pragma once
/// Bodies of design/compressed_rows.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/design/compressed_rows.hpp>
#include <gonio/solve/dense.hpp>
#include <gonio/solve/symmetric_eigen.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace gonio::design::detail {

GONIO_INLINE std::vector<std::pair<Eigen::Index, double>> cells_next_to(std::span<const half_difference> directions,
                                                                        const valid_cells& cells) {
  const grid& grid = cells.grid();
  std::vector<Eigen::Index> met;
  met.reserve(directions.size());
  for (const half_difference& angles : directions)
    met.push_back(cells.representative(grid.linear(grid.nearest(angles))));
  std::sort(met.begin(), met.end());

  std::vector<std::pair<Eigen::Index, double>> counts;
  for (const Eigen::Index cell : met) {
    if (counts.empty() || counts.back().first != cell) counts.emplace_back(cell, 0.0);
    counts.back().second += 1.0;
  }
  return counts;
}

/// Returns V' R and V' O, where `vectors` are the orthonormal columns V and `rows` are (R, O).
[[nodiscard]] GONIO_INLINE component_rows turned(const Eigen::MatrixXd& vectors, const component_rows& rows) {
  component_rows turned{product(vectors.transpose(), rows.components), Eigen::VectorXd(vectors.cols())};
  for (Eigen::Index j = 0; j < vectors.cols(); ++j) turned.noise[j] = vectors.col(j).dot(rows.noise);
  return turned;
}

/// Returns L^1/2 V' and L^-1/2 V'R'O, where `values` are the eigenvalues L of R'R, `vectors` its eigenvectors V, and
/// `rows` are (R, O).
[[nodiscard]] GONIO_INLINE component_rows scaled(const Eigen::MatrixXd& vectors, std::span<const double> values,
                                                 const component_rows& rows) {
  const Eigen::Index k = vectors.rows(), kept = vectors.cols();
  Eigen::VectorXd noise(k);  // R'O
  for (Eigen::Index j = 0; j < k; ++j) noise[j] = rows.components.col(j).dot(rows.noise);
  component_rows few{Eigen::MatrixXd(kept, k), Eigen::VectorXd(kept)};
  for (Eigen::Index i = 0; i < kept; ++i) {
    const double root = std::sqrt(values[i]);
    for (Eigen::Index j = 0; j < k; ++j) few.components(i, j) = root * vectors(j, i);
    few.noise[i] = vectors.col(i).dot(noise) / root;
  }
  return few;
}

}  // namespace gonio::design::detail

namespace gonio::design {

GONIO_INLINE component_rows compressed(const component_rows& rows, double negligible) {
  const Eigen::MatrixXd& r = rows.components;
  const bool tall = r.rows() > r.cols();
  const symmetric_eigen eigen = decompose_symmetric(
      tall ? product_with_transpose(r.transpose()) : product_with_transpose(r), "a Gram matrix of measurements");
  const std::span<const double> values(eigen.values.data(), eigen.values.size());
  const Eigen::Index kept = std::ranges::count_if(values, [&](double value) { return value > negligible; });
  const Eigen::MatrixXd vectors = eigen.vectors.rightCols(kept);
  return tall ? detail::scaled(vectors, values.last(kept), rows) : detail::turned(vectors, rows);
}

}  // namespace gonio::design
