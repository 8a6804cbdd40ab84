#pragma once
/// Learning principal components from tables, through the Gram matrix of the observations: with m columns
/// of a million cells, m x m is small and cells x cells is never formed. Nielsen et al. 2015, Eq. 4-6.

#include <gonio/basis/pca.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/solve/gram.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>

namespace gonio {

namespace detail {

/// Maps every value by the metric and takes the mean of each row away, in place. Returns the means.
template <observation_set Set, error_metric Metric>
[[nodiscard]] std::vector<float> map_and_centre(Set& materials, const Metric& metric, thread_count threads) {
  std::vector<float> mean(materials.cells.size());
  for_each_block(
      mean.size(), 1024,
      [&](block range) {
        for (std::size_t cell = range.begin; cell < range.end; ++cell) {
          const location at = locate_cell(materials.cells, cell);
          map_cell(materials, cell, [&](double rho) { return metric.forward(rho, at); });
          auto row = materials.values.row(static_cast<Eigen::Index>(cell));
          mean[cell] = static_cast<float>(row.template cast<double>().mean());
          row.array() -= mean[cell];
        }
      },
      threads);
  return mean;
}

/// Eigenvectors of a Gram matrix for its `count` largest eigenvalues above rounding, largest first, each
/// with its largest entry positive so that the result does not depend on the eigensolver's sign.
struct spectrum {
  Eigen::VectorXd eigenvalues;
  Eigen::MatrixXd eigenvectors;
};

template <class Derived>
[[nodiscard]] spectrum largest_eigenpairs(const Eigen::MatrixBase<Derived>& gram, Eigen::Index count) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  if (eigen.info() != Eigen::Success)
    throw error("the eigenvalues of the Gram matrix of the materials did not converge");
  const Eigen::VectorXd descending = eigen.eigenvalues().reverse();
  const double floor = descending[0] * static_cast<double>(gram.rows()) * std::numeric_limits<double>::epsilon();
  const Eigen::Index kept = std::min<Eigen::Index>(count, (descending.array() > floor).count());
  spectrum result{descending.head(kept), eigen.eigenvectors().rowwise().reverse().leftCols(kept)};
  for (auto vector : result.eigenvectors.colwise()) {
    Eigen::Index largest = 0;
    vector.cwiseAbs().maxCoeff(&largest);
    if (vector[largest] < 0.0) vector = -vector;
  }
  return result;
}

}  // namespace detail

/// Principal components of the materials under a metric over the same cells. Keeps at most `components`;
/// fewer where the rest is rounding (centring always costs one). The set is consumed: its 4 bytes per value
/// are mapped in place, and the result takes 4 bytes per cell and component more.
/// O(cells m^2), deterministic for any number of threads. Throws gonio::error for fewer than two
/// observations or a value that is not finite, before mapping or after. Other things than materials are learned from
/// in the same way: shapes, in shape/shape_model.hpp.
///
/// ```cpp
/// const auto metric = gonio::log_relative::to_median_of(materials);
/// const auto prior = gonio::learn_pca(std::move(materials), metric, 60);
/// ```
template <observation_set Set, error_metric Metric>
[[nodiscard]] pca<Metric, domain_of_set<Set>> learn_pca(Set materials, const Metric& metric, std::size_t components,
                                                        thread_count threads = {}, const progress& listener = {}) {
  if (components == 0) throw error("at least one principal component must be kept");
  require_complete(materials);
  report(listener, "mapping", 0.0);
  std::vector<float> mean = detail::map_and_centre(materials, metric, threads);

  report(listener, "gram", 0.0);
  const Eigen::MatrixXd products = gram(materials.values, threads);
  report(listener, "components", 0.0);
  // Rounding of the mean may pretend that centring costs none.
  const auto most = std::min(static_cast<Eigen::Index>(components), products.cols() - 1);
  const auto [eigenvalues, vectors] = detail::largest_eigenpairs(products, most);
  if (eigenvalues.size() == 0) throw error("the materials do not differ: there is nothing to learn");

  // X - mu = U Sigma V' transposed: Q = V Sigma = (X - mu)' U, where U are the eigenvectors.
  const Eigen::MatrixXf u = vectors.cast<float>();
  cell_matrix scaled(materials.values.rows(), u.cols());
  for_each_block(
      materials.cells.size(), 2048,
      [&](block range) {
        const auto begin = static_cast<Eigen::Index>(range.begin), count = static_cast<Eigen::Index>(range.size());
        scaled.middleRows(begin, count).noalias() = materials.values.middleRows(begin, count) * u;
      },
      threads);
  report(listener, "components", 1.0);
  return pca<Metric, domain_of_set<Set>>({materials.cells, metric, std::move(materials.names), eigenvalues.cwiseSqrt(),
                                          std::move(scaled), std::move(mean), u, eigenvalues.sum() / products.trace()});
}

/// The same components on other, usually fewer, cells: components and mean are interpolated in the mapped
/// domain, or copied where the cells' nodes coincide. The metric must be able to move: `metric.on(cells)`.
template <error_metric Metric>
[[nodiscard]] pca<Metric> thin(const pca<Metric>& basis, const valid_cells& cells) {
  cell_matrix components(static_cast<Eigen::Index>(cells.size()), static_cast<Eigen::Index>(basis.size()));
  std::vector<float> mean(cells.size());
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const location at = locate(basis.cells(), cells.angles(cell));
    components.row(static_cast<Eigen::Index>(cell)) = row_at(basis, at).template cast<float>();
    mean[cell] = static_cast<float>(offset_at(basis, at));
  }
  return pca<Metric>({cells, basis.metric().on(cells), basis.names(), basis.singular_values(), std::move(components),
                      std::move(mean), basis.coefficients(), basis.explained_variance(), basis.source()});
}

}  // namespace gonio
