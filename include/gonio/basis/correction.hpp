#pragma once
/// Correction functions: what the approximation of each measured material by the others must be multiplied by to become
/// that material. Noell, Koehler and Stricker 2014, section 2, Eq. 3-6.

#include <gonio/basis/measured.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/solve/nnls.hpp>

#include <Eigen/Core>

#include <array>

namespace gonio {

/// How a quotient of reflectances is kept finite where its denominator is zero or tiny, as it is at every hundredth cell
/// of some measured materials.
struct quotient_floor {
  /// Denominators count as at least this, in sr^-1: a millionth of what a white surface has.
  double smallest = 1e-6;
};

namespace detail {

/// The approximations of all materials by the others, one column of weights for each, for one channel.
template <error_metric Metric, normal_solver Solver>
[[nodiscard]] Eigen::MatrixXf leave_one_out_weights(const material_channel<Metric>& functions, const Solver& solver,
                                                    thread_count threads) {
  const Eigen::MatrixXd products = functions.products(threads);
  const std::vector<Eigen::Index> columns(functions.columns().begin(), functions.columns().end());
  const auto unknowns = static_cast<Eigen::Index>(functions.size());
  Eigen::MatrixXf weights = Eigen::MatrixXf::Zero(unknowns, static_cast<Eigen::Index>(columns.size()));
  for_each_block(
      columns.size(), 1,
      [&](block one) {
        std::vector<Eigen::Index> others = columns;
        std::erase(others, columns[one.begin]);
        const solution found = solver.solve(leave_one_out(products, columns[one.begin], others));
        weights.col(static_cast<Eigen::Index>(one.begin)) =
            spread(found, others, unknowns).weights.template cast<float>();
      },
      threads);
  return weights;
}

/// Turns an array of mapped values into reflectances, at least zero.
template <error_metric Metric, class Values>
void unmap_at_cells(const Metric& metric, const valid_cells& cells, std::size_t first, Values&& values) {
  if constexpr (requires { metric.unmap_all(values); }) {
    metric.unmap_all(values);
    values = values.max(0.0f);
  } else {
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      const location at = locate_cell(cells, first + static_cast<std::size_t>(i));
      for (Eigen::Index j = 0; j < values.cols(); ++j)
        values(i, j) = static_cast<float>(std::max(metric.inverse(values(i, j), at), 0.0));
    }
  }
}

/// M_i / max(approximation of M_i, floor) for all materials that take part, and 1 as the last column of each channel.
template <error_metric Metric, normal_solver Solver>
[[nodiscard]] cell_matrix correction_tables(const measured<Metric>& materials, const Solver& solver,
                                            const quotient_floor& floor, thread_count threads) {
  using values = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const std::vector<Eigen::Index> columns = columns_of(materials);
  const auto count = static_cast<Eigen::Index>(columns.size());
  const auto smallest = static_cast<float>(floor.smallest);
  cell_matrix tables(static_cast<Eigen::Index>(materials.cells().size()), 3 * (count + 1));
  for (std::size_t c = 0; c < 3; ++c) {
    const auto channel = materials.channel(c);
    const Eigen::MatrixXf weights = leave_one_out_weights(channel, solver, threads);
    for_each_block(
        materials.cells().size(), 512,
        [&](block range) {
          const auto begin = static_cast<Eigen::Index>(range.begin), rows = static_cast<Eigen::Index>(range.size());
          const auto mapped = channel.values().middleRows(begin, rows);
          values approximation(rows, count), truth(rows, count);
          approximation.matrix().noalias() = mapped * weights;
          for (Eigen::Index j = 0; j < count; ++j) truth.col(j) = mapped.col(columns[static_cast<std::size_t>(j)]);
          unmap_at_cells(materials.metric(), materials.cells(), range.begin, approximation);
          unmap_at_cells(materials.metric(), materials.cells(), range.begin, truth);
          auto out = tables.block(begin, static_cast<Eigen::Index>(c) * (count + 1), rows, count + 1);
          out.leftCols(count) = truth / approximation.max(smallest);
          out.col(count).setOnes();
        },
        threads);
  }
  return tables;
}

/// Names of the materials that take part.
template <error_metric Metric>
[[nodiscard]] std::vector<std::string> names_of(const measured<Metric>& materials) {
  std::vector<std::string> names;
  for (const Eigen::Index column : materials.columns())
    names.push_back(materials.names()[static_cast<std::size_t>(column)]);
  return names;
}

}  // namespace detail

/// Corrections C_i of the materials of a basis, one for each, and the constant function 1 as the last, with which an
/// estimate that needs no correction is left as it is. Their metric is linear (Eq. 16).
///
/// A material that the `measured` basis leaves out is in no correction's approximation either. `without` only takes its
/// own correction away: the others may still have it in their approximations, which changes the results little and
/// saves an experiment over all materials from computing the corrections anew for each.
///
/// ```cpp
/// const gonio::measured materials{gonio::expand(prior), gonio::log{}};
/// const gonio::correction corrections{materials.without({"chrome"})};
/// ```
class correction : public material_functions<lin> {
 public:
  /// O(cells materials^2). Throws gonio::error if there are fewer than two materials, or the solver gives up.
  template <error_metric Metric, normal_solver Solver = nnls>
  explicit correction(const measured<Metric>& materials, const Solver& solver = {}, const quotient_floor& floor = {},
                      thread_count threads = {})
      : material_functions<lin>(detail::names_of(materials), materials.cells(), lin{},
                                detail::correction_tables(materials, solver, floor, threads)) {}

  /// The same basis in which the corrections of the materials of these names take no part. Nothing is copied. Throws
  /// gonio::error for a name that there is not, or if none is left.
  [[nodiscard]] correction without(const std::vector<std::string>& excluded) const {
    correction fewer(*this);
    fewer.leave_out(excluded);
    return fewer;
  }
};

}  // namespace gonio
