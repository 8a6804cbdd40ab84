#pragma once
/// The materials that a learned prior remembers, as tables again.

#include <gonio/basis/pca.hpp>
#include <gonio/solve/product.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Core>

namespace gonio {

/// Every material that principal components were learned from, over the components' own cells, as far as they are kept:
/// mu + Q c mapped back, at least zero. Lets the small file of a prior stand in for the database wherever a
/// `material_set` is wanted. O(cells x materials x components).
template <error_metric Metric>
[[nodiscard]] material_set expand(const pca<Metric>& prior, thread_count threads = {}) {
  material_set materials{prior.cells(), prior.names(), {}};
  const Eigen::Index columns = prior.coefficients().rows();
  materials.values.resize(prior.cells().size(), columns);
  const Eigen::MatrixXd coefficients = prior.coefficients().transpose().template cast<double>();
  for_each_block(
      prior.cells().size(), 1024,
      [&](block range) {
        const Eigen::Index begin = range.begin, count = range.size();
        auto rows = materials.values.middleRows(begin, count);
        const Eigen::MatrixXd mapped =
            product(prior.components().middleRows(begin, count).template cast<double>(), coefficients);
        for (Eigen::Index i = 0; i < count; ++i) {
          const Eigen::Index cell = begin + i;
          const location at = locate_cell(prior.cells(), cell);
          for (Eigen::Index j = 0; j < columns; ++j)
            rows(i, j) =
                static_cast<float>(std::max(prior.metric().inverse(mapped(i, j) + prior.offset(cell), at), 0.0));
        }
      },
      threads);
  return materials;
}

#if defined(GONIO_COMPILED)
extern template material_set expand(const log_relative_pca& prior, thread_count threads);
#endif

}  // namespace gonio
