#pragma once
/// Correction functions: what the approximation of each measured material by the others must be multiplied by to become
/// that material. Noell, Koehler and Stricker 2014, section 2, Eq. 3-6.

#include <gonio/basis/measured.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/solve/nnls.hpp>

#include <Eigen/Core>

#include <array>

namespace gonio {

/// What an estimate must be multiplied by, Eq. 4, 5 and 12, kept finite where the estimate is zero or tiny: measured
/// materials have cells that are exactly zero.
struct correction_factor {
  /// Added to measurement and estimate, in sr^-1: differences well below it do not matter. A white surface has 0.318.
  float offset = 1e-3f;
  /// The denominator is at least this.
  float smallest = 1e-6f;

  /// Factors and estimates count as at most these: a combination of materials that is extrapolated from a few bad
  /// samples leaves the range of float, and so do products of some rounds.
  static constexpr float largest_factor = 1e12f, largest_estimate = 1e24f;

  /// The quotient as the paper prints it; only a denominator below a millionth is replaced by that.
  [[nodiscard]] static constexpr correction_factor as_printed() noexcept { return {0.0f, 1e-6f}; }

  /// sigma from a measurement and its estimate (numbers, or arrays of them). Negative measurements count as zero.
  template <class Values>
  [[nodiscard]] auto quotient(const Values& measured, const Values& estimate) const {
    return ((measured.max(0.0f) + offset) / (estimate + offset).max(smallest)).min(largest_factor);
  }

  /// The estimate corrected by sigma, at least zero.
  template <class Values>
  [[nodiscard]] auto correct(const Values& estimate, const Values& sigma) const {
    return (sigma.min(largest_factor) * (estimate.min(largest_estimate) + offset).max(smallest) - offset).max(0.0f);
  }
};

/// How correction functions are made and used.
struct correction_rule {
  correction_factor factor = {};
  /// Is the constant function 1 among them? It stops the iteration from drifting: where nothing is left to correct,
  /// the others can only come near to 1.
  bool has_constant = true;

  /// The correction functions of the paper: one for each material, nothing else.
  [[nodiscard]] static constexpr correction_rule as_printed() noexcept {
    return {correction_factor::as_printed(), false};
  }
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

/// The factors that turn the approximations of all materials that take part into the materials; then, if the rule has
/// it, 1 as the last column of each channel.
template <error_metric Metric, normal_solver Solver>
[[nodiscard]] cell_matrix correction_tables(const measured<Metric>& materials, const Solver& solver,
                                            const correction_rule& rule, thread_count threads) {
  using values = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const std::vector<Eigen::Index> columns = columns_of(materials);
  const auto count = static_cast<Eigen::Index>(columns.size());
  if (count < 2) throw error("correction functions need at least two materials: each is explained by the others");
  const Eigen::Index functions = count + (rule.has_constant ? 1 : 0);
  cell_matrix tables(static_cast<Eigen::Index>(materials.cells().size()), 3 * functions);
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
          auto out = tables.block(begin, static_cast<Eigen::Index>(c) * functions, rows, functions);
          out.leftCols(count) = rule.factor.quotient(truth, approximation);
          out.rightCols(functions - count).setOnes();
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
/// own correction away: the others may still have it in their approximations, which makes fits of that very material
/// worse than they would be for a material that the database does not have (docs/robust-estimation.md).
///
/// ```cpp
/// const gonio::measured materials{gonio::expand(prior), gonio::log{}};
/// const gonio::correction corrections{materials.without({"chrome"})};
/// ```
class correction : public material_functions<lin> {
 public:
  /// O(cells materials^2). Throws gonio::error if there are fewer than two materials, or the solver gives up.
  template <error_metric Metric, normal_solver Solver = nnls>
  explicit correction(const measured<Metric>& materials, const correction_rule& rule = {}, const Solver& solver = {},
                      thread_count threads = {})
      : material_functions<lin>(detail::names_of(materials), materials.cells(), lin{},
                                detail::correction_tables(materials, solver, rule, threads)),
        rule_(rule) {}

  /// How the corrections were made, and how they are to be applied.
  [[nodiscard]] const correction_rule& rule() const noexcept { return rule_; }

  /// The same basis in which the corrections of the materials of these names take no part. Nothing is copied. Throws
  /// gonio::error for a name that there is not, or if none is left.
  [[nodiscard]] correction without(const std::vector<std::string>& excluded) const {
    correction fewer(*this);
    fewer.leave_out(excluded);
    return fewer;
  }

 private:
  correction_rule rule_;
};

static_assert(channelwise_basis<correction>);

}  // namespace gonio
