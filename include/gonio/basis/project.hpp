#pragma once
/// The best fit by principal components: the orthogonal projection of a full table.

#include <gonio/basis/pca.hpp>
#include <gonio/table/brdf_table.hpp>

#include <Eigen/Core>

namespace gonio {

/// Returns the weights, k x 3, of the projection of a table on the components: c = Sigma^-2 Q'(x - mu), because Q = V
/// Sigma and V has orthonormal columns. Exact only over the cells on which the basis was learned. Throws gonio::error
/// unless the table is over the basis' cells. Components whose singular value is below 1e-5 of the first get no weight.
/// O(cells x k).
template <error_metric Metric>
[[nodiscard]] Eigen::MatrixXd project(const pca<Metric>& basis, const brdf_table& table, thread_count threads = {}) {
  if (!(table.cells() == basis.cells())) refuse("a table projected on a basis must be over the cells of the basis");
  const Eigen::Index k = basis.size();
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(k, 3);
  Eigen::MatrixXd products = sum_over_blocks(
      table.cells().size(), 1024, zero,
      [&](Eigen::MatrixXd& sum, block range) {
        const Eigen::Index begin = range.begin, count = range.size();
        Eigen::MatrixXd mapped(count, 3);
        for (Eigen::Index i = 0; i < count; ++i) {
          const Eigen::Index cell = begin + i;
          const location at = locate_cell(table.cells(), cell);
          const rgb value = table.at(cell);
          for (Eigen::Index channel = 0; channel < 3; ++channel)
            mapped(i, channel) = basis.metric().forward(value[channel], at) - basis.offset(cell);
        }
        sum.noalias() += basis.components().middleRows(begin, count).transpose().template cast<double>() * mapped;
      },
      threads);
  const Eigen::ArrayXd sigma = basis.singular_values().array();
  const Eigen::ArrayXd inverse = (sigma > 1e-5 * sigma[0]).select(sigma.square().inverse(), 0.0);
  return inverse.matrix().asDiagonal() * products;
}

}  // namespace gonio
