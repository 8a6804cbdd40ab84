#pragma once
/// Expands the materials of a learned prior to tables.

#include <gonio/basis/pca.hpp>
#include <gonio/solve/product.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <span>

namespace gonio {

namespace detail {

/// Returns the contribution of each channel of a prior's materials to red, green and blue under D65: 3 x channels.
/// Throws gonio::error if none of several wavelengths is visible.
[[nodiscard]] Eigen::MatrixXd colours_of_channels(std::span<const double> wavelengths);

}  // namespace detail

/// Returns all materials from which principal components were learned, over the components' own cells, as approximated
/// by the kept components: mu + Q c mapped back, at least zero. Spectra become their colours under D65, also at least
/// zero. The small file of a prior can then replace the database wherever a `material_set` is needed. O(cells x
/// observations x components). Throws gonio::error if none of several wavelengths is visible.
template <error_metric Metric>
[[nodiscard]] material_set expand(const pca<Metric>& prior, thread_count threads = {}) {
  const Eigen::Index channels = prior.channels(), count = std::ssize(prior.names());
  material_set materials{prior.cells(), prior.names(), cell_matrix(prior.cells().size(), 3 * count)};
  const Eigen::MatrixXd coefficients = prior.coefficients().transpose().template cast<double>(),
                        colours = detail::colours_of_channels(prior.wavelengths());
  for_each_block(
      prior.cells().size(), 1024,
      [&](block range) {
        Eigen::MatrixXd values =
            product(prior.components().middleRows(range.begin, range.size()).template cast<double>(), coefficients);
        for (Eigen::Index i = 0; i < values.rows(); ++i) {
          const Eigen::Index cell = range.begin + i;
          const location at = locate_cell(prior.cells(), cell);
          for (Eigen::Index j = 0; j < values.cols(); ++j)
            values(i, j) = reflectance_of(prior.metric(), values(i, j) + prior.offset(cell), at);
          for (Eigen::Index m = 0; m < count; ++m)
            for (Eigen::Index c = 0; c < 3; ++c) {
              double sum = 0.0;
              for (Eigen::Index j = 0; j < channels; ++j)
                if (colours(c, j) != 0.0) sum += colours(c, j) * values(i, channels * m + j);
              materials.values(cell, 3 * m + c) = static_cast<float>(std::max(sum, 0.0));
            }
        }
      },
      threads);
  return materials;
}

#if defined(GONIO_COMPILED)
extern template material_set expand(const log_relative_pca& prior, thread_count threads);
#endif

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/expand_materials.ipp>
#endif
