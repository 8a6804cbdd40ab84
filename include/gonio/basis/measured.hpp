#pragma once
/// Measured materials as basis functions: Noell, Koehler and Stricker 2014, Eq. 3, 7 and 11, with the materials' tables
/// mapped by the metric.

#include <gonio/basis/material_functions.hpp>
#include <gonio/metric/log.hpp>

#include <Eigen/Core>

namespace gonio {

namespace detail {

/// Maps every value of a set and sorts each row by channel: red of all materials, then green, then blue.
template <error_metric Metric>
[[nodiscard]] cell_matrix map_by_channel(material_set& materials, const Metric& metric, thread_count threads) {
  require_complete(materials);
  const Eigen::Index count = materials.values.cols() / 3;
  for_each_block(
      materials.cells.size(), 1024,
      [&](block range) {
        Eigen::RowVectorXf sorted(3 * count);
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
          const location at = locate_cell(materials.cells, cell);
          map_cell(materials, cell, [&](double rho) { return metric.forward(rho, at); });
          auto row = materials.values.row(cell);
          for (Eigen::Index i = 0; i < count; ++i)
            for (Eigen::Index c = 0; c < 3; ++c) sorted[c * count + i] = row[3 * i + c];
          row = sorted;
        }
      },
      threads);
  return std::move(materials.values);
}

#if defined(GONIO_COMPILED)
extern template cell_matrix map_by_channel(material_set& materials, const log& metric, thread_count threads);
#endif

}  // namespace detail

/// Measured materials over the valid cells of a grid, one basis for each colour channel.
///
/// ```cpp
/// const gonio::measured materials{gonio::expand(prior), gonio::log{}};
/// const auto paint = gonio::decomposition{materials.without({"chrome"}), gonio::nnls{}}.fit(samples);
/// ```
template <error_metric Metric>
class measured : public material_functions<Metric> {
 public:
  /// Maps the tables in place: the set is consumed. O(cells x materials). Throws gonio::error if there is no material,
  /// or if a value is not finite, before mapping or after; the message names the material and the first such cell.
  measured(material_set materials, Metric metric, thread_count threads = {})
      : material_functions<Metric>(materials.names, materials.cells, metric,
                                   detail::map_by_channel(materials, metric, threads)) {}

  /// Returns the same basis with the materials of these names excluded from fits, without a copy. Throws gonio::error
  /// for an unknown name, or if no material is left.
  [[nodiscard]] measured without(const std::vector<std::string>& excluded) const {
    measured fewer(*this);
    fewer.leave_out(excluded);
    return fewer;
  }
};

}  // namespace gonio
