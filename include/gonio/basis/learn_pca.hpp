#pragma once
/// Learns principal components from tables, through the Gram matrix of the observations, which has m x m numbers for m
/// observations. No matrix of cells x cells is formed. Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Eq. 4-6.

#include <gonio/basis/pca.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace gonio {

namespace detail {

/// Maps every value by the metric and subtracts the mean of each row, in place. Returns the means.
template <observation_set Set, error_metric Metric>
[[nodiscard]] std::vector<float> map_and_centre(Set& materials, const Metric& metric, thread_count threads) {
  std::vector<float> mean(materials.cells.size());
  for_each_index(
      mean.size(), 1024,
      [&](Eigen::Index cell) {
        const location at = locate_cell(materials.cells, cell);
        map_cell(materials, cell, [&](double rho) { return metric.forward(rho, at); });
        auto row = materials.values.row(cell);
        mean[cell] = static_cast<float>(row.template cast<double>().mean());
        row.array() -= mean[cell];
      },
      threads);
  return mean;
}

/// The factors of X - mu = U Sigma V', whose rows are observations, truncated to the kept components.
struct component_set {
  Eigen::VectorXd singular_values;
  cell_matrix scaled;            ///< Q = V Sigma = (X - mu)' U, a row for each cell
  Eigen::MatrixXf coefficients;  ///< U
  double explained_variance = 1.0;
};

/// Returns at most `count` components of centred rows, the largest first, without components that are only rounding
/// errors. The largest entry of each column of U is positive: the result does not depend on the eigensolver's sign.
/// Throws gonio::error if there is no component.
[[nodiscard]] component_set principal_components(const cell_matrix& centred, Eigen::Index count, thread_count threads,
                                                 const progress& listener);

}  // namespace detail

/// Returns the principal components of the materials under a metric over the same cells: at most `components`, without
/// those that are only rounding errors (centring always removes one). The set is consumed: its 4 bytes per value are
/// mapped in place, and the result needs 4 bytes more per cell and component. O(cells m^2), deterministic for any
/// number of threads. Throws gonio::error for fewer than two observations or a value that is not finite, before mapping
/// or after. Other observations are learned in the same way, such as shapes in shape/shape_model.hpp.
///
/// ```cpp
/// const auto metric = gonio::log_relative::to_median_of(materials);
/// const auto prior = gonio::learn_pca(std::move(materials), metric, 60);
/// ```
template <observation_set Set, error_metric Metric>
[[nodiscard]] pca<Metric, domain_of_set<Set>> learn_pca(Set materials, const Metric& metric, Eigen::Index components,
                                                        thread_count threads = {}, const progress& listener = {}) {
  if (components < 1) refuse("at least one principal component must be kept");
  require_complete(materials);
  report(listener, "mapping", 0.0);
  std::vector<float> mean = detail::map_and_centre(materials, metric, threads);

  detail::component_set found = detail::principal_components(materials.values, components, threads, listener);
  return pca<Metric, domain_of_set<Set>>({materials.cells, metric, std::move(materials.names),
                                          std::move(found.singular_values), std::move(found.scaled), std::move(mean),
                                          std::move(found.coefficients), found.explained_variance});
}

/// Returns the same components on other, usually fewer, cells. Components and mean are interpolated in the mapped
/// domain, or copied if the cells' nodes coincide. The metric must have `metric.on(cells)`.
template <error_metric Metric>
[[nodiscard]] pca<Metric> thin(const pca<Metric>& basis, const valid_cells& cells) {
  cell_matrix components(cells.size(), basis.size());
  std::vector<float> mean(cells.size());
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    const location at = locate(basis.cells(), cells.angles(cell));
    components.row(cell) = row_at(basis, at).template cast<float>();
    mean[cell] = static_cast<float>(offset_at(basis, at));
  }
  return pca<Metric>({cells, basis.metric().on(cells), basis.names(), basis.singular_values(), std::move(components),
                      std::move(mean), basis.coefficients(), basis.explained_variance(), basis.source(),
                      basis.wavelengths()});
}

#if defined(GONIO_COMPILED)
extern template log_relative_pca thin(const log_relative_pca& basis, const valid_cells& cells);
#endif

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/learn_pca.ipp>
#endif
