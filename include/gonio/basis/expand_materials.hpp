#pragma once
/// The materials that a learned prior remembers, as tables again.

#include <gonio/basis/pca.hpp>
#include <gonio/solve/float_product.hpp>
#include <gonio/table/material_set.hpp>

namespace gonio {

/// Every material that principal components were learned from, over the components' own cells, as far as they are kept:
/// mu + Q c mapped back, at least zero. Lets the small file of a prior stand in for the database wherever a
/// `material_set` is wanted. O(cells x materials x components).
template <error_metric Metric>
[[nodiscard]] material_set expand(const pca<Metric>& prior, thread_count threads = {}) {
  material_set materials{prior.cells(), prior.names(), {}};
  const Eigen::Index columns = prior.coefficients().rows();
  materials.values.setZero(static_cast<Eigen::Index>(prior.cells().size()), columns);
  for_each_block(
      prior.cells().size(), 1024,
      [&](block range) {
        const auto begin = static_cast<Eigen::Index>(range.begin), count = static_cast<Eigen::Index>(range.size());
        auto rows = materials.values.middleRows(begin, count);
        add_product(prior.coefficients(), prior.components().middleRows(begin, count).transpose(), rows.transpose());
        for (Eigen::Index i = 0; i < count; ++i) {
          const auto cell = static_cast<std::size_t>(begin + i);
          const location at = locate_cell(prior.cells(), cell);
          for (Eigen::Index j = 0; j < columns; ++j) {
            const double mapped = rows(i, j) + prior.offset(cell);
            rows(i, j) = static_cast<float>(std::max(prior.metric().inverse(mapped, at), 0.0));
          }
        }
      },
      threads);
  return materials;
}

}  // namespace gonio
