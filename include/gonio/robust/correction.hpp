#pragma once
/// Correction functions: each measured material divided by its approximation by the other materials. Noell, Koehler and
/// Stricker 2014, section 2, Eq. 3-6.

#include <gonio/basis/measured.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/solve/float_product.hpp>
#include <gonio/solve/nnls.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace gonio {

/// The factor that corrects an estimate, Eq. 4, 5 and 12. The factor is finite even if the estimate is zero or tiny:
/// measured materials have cells that are exactly zero.
struct correction_factor {
  /// Added to measurement and estimate, in sr^-1, so that differences much smaller than this offset have little effect.
  /// For comparison: the BRDF of a white diffuser is 0.318.
  float offset = 1e-3f;
  /// The smallest denominator.
  float smallest = 1e-6f;

  /// The largest factor and the largest estimate; larger ones are clamped. Unclamped, a combination of materials
  /// extrapolated from a few bad samples may exceed the range of float, and so may the product of several rounds'
  /// factors.
  static constexpr float largest_factor = 1e12f, largest_estimate = 1e24f;

  /// Returns the factor as printed in the paper, except that denominators below a millionth are replaced by a
  /// millionth.
  [[nodiscard]] static constexpr correction_factor as_printed() noexcept { return {0.0f, 1e-6f}; }

  /// Returns sigma, given arrays of measurements and of their estimates. Negative measurements count as zero.
  template <class Values>
  [[nodiscard]] auto quotient(const Values& measured, const Values& estimate) const {
    return ((measured.max(0.0f) + offset) / (estimate + offset).max(smallest)).min(largest_factor);
  }

  /// Returns the estimate corrected by sigma, at least zero.
  template <class Values>
  [[nodiscard]] auto correct(const Values& estimate, const Values& sigma) const {
    return (sigma.min(largest_factor) * (estimate.min(largest_estimate) + offset).max(smallest) - offset).max(0.0f);
  }
};

/// How correction functions are made and used.
struct correction_rule {
  correction_factor factor = {};
  /// Whether to add the constant function 1. This function keeps the iteration from drifting: if nothing is left to
  /// correct, the other functions can only approximate 1.
  bool has_constant = true;

  /// Returns the rule of the paper: one correction function for each material, nothing else.
  [[nodiscard]] static constexpr correction_rule as_printed() noexcept {
    return {correction_factor::as_printed(), false};
  }
};

namespace detail {

/// Converts an array of mapped values, a row for each cell, to reflectances, at least zero. Row 0 belongs to cell
/// `first`.
template <error_metric Metric, class Values>
void unmap_at_cells(const Metric& metric, const valid_cells& cells, Eigen::Index first, Values& values) {
  const std::span<float> all(values.data(), values.size());
  if constexpr (requires { metric.unmap_all(all); }) {
    metric.unmap_all(all);
    values = values.max(0.0f);
  } else if constexpr (requires { metric.held(); }) {
    std::visit([&](const auto& one) { unmap_at_cells(one, cells, first, values); }, metric.held());
  } else {
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      const location at = locate_cell(cells, first + i);
      for (Eigen::Index j = 0; j < values.cols(); ++j)
        values(i, j) = static_cast<float>(reflectance_of(metric, values(i, j), at));
    }
  }
}

/// Approximates each material of a basis by all other materials that are not excluded, and computes the factors that
/// correct these approximations.
template <error_metric Metric, normal_solver Solver>
class leave_one_out_approximations {
 public:
  /// Throws gonio::error if fewer than two materials are left after exclusions.
  leave_one_out_approximations(measured<Metric> materials, const Solver& solver, thread_count threads)
      : materials_(at_least_two(std::move(materials))), solver_(solver), threads_(threads) {
    const Eigen::Index count = materials_.size();
    std::vector<Eigen::Index> all(materials_.size());
    std::iota(all.begin(), all.end(), Eigen::Index{0});
    for (Eigen::Index c = 0; c < 3; ++c) {
      weights_[c] = Eigen::MatrixXf::Zero(count, count);
      approximate(c, all);
    }
    renewed_.fill(all);
  }

  [[nodiscard]] const measured<Metric>& materials() const noexcept { return materials_; }

  /// Returns a copy without the materials of these names. Recomputes only the approximations that used one of these
  /// materials.
  [[nodiscard]] leave_one_out_approximations without(const std::vector<std::string>& excluded) const {
    leave_one_out_approximations fewer(*this);
    fewer.materials_ = at_least_two(materials_.without(excluded));
    for (Eigen::Index c = 0; c < 3; ++c) {
      fewer.renewed_[c].clear();
      for (const Eigen::Index i : fewer.materials_.columns())
        if (std::ranges::any_of(materials_.columns(), [&](Eigen::Index other) {
              return weights_[c](other, i) != 0.0f && !std::ranges::binary_search(fewer.materials_.columns(), other);
            }))
          fewer.renewed_[c].push_back(i);
      fewer.approximate(c, fewer.renewed_[c]);
    }
    return fewer;
  }

  /// Writes the correction factors into `tables`, cells x 3 `functions`. Writes only the columns of materials whose
  /// approximations the constructor or the latest `without` computed.
  void write_factors(const correction_factor& factor, cell_matrix& tables, Eigen::Index functions) const {
    for (Eigen::Index c = 0; c < 3; ++c) {
      auto channel = tables.middleCols(c * functions, functions);
      if (std::ssize(renewed_[c]) == materials_.size())  // no need to look up single columns
        write_columns(c, Eigen::seqN(Eigen::Index{0}, weights_[c].cols()), factor, channel);
      else
        write_columns(c, renewed_[c], factor, channel);
    }
  }

  [[nodiscard]] thread_count threads() const noexcept { return threads_; }

 private:
  [[nodiscard]] static measured<Metric> at_least_two(measured<Metric> materials) {
    if (materials.columns().size() < 2)
      refuse("correction functions need at least two materials, because each is approximated by all others");
    return materials;
  }

  template <class Columns, class Channel>
  void write_columns(Eigen::Index c, const Columns& columns, const correction_factor& factor, Channel& out) const {
    using values = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto channel = materials_.channel(c);
    const Eigen::MatrixXf transposed = weights_[c](Eigen::all, columns).transpose();
    for_each_block(
        materials_.cells().size(), 128,
        [&](block range) {
          const Eigen::Index begin = range.begin, rows = range.size();
          const auto mapped = channel.values().middleRows(begin, rows);
          values approximation = values::Zero(rows, transposed.rows()), truth = mapped(Eigen::all, columns);
          add_product(transposed, mapped.transpose(), approximation.matrix().transpose());
          unmap_at_cells(materials_.metric(), materials_.cells(), range.begin, approximation);
          unmap_at_cells(materials_.metric(), materials_.cells(), range.begin, truth);
          truth = factor.quotient(truth, approximation).eval();
          out.middleRows(begin, rows)(Eigen::all, columns) = truth.matrix();
        },
        threads_);
  }

  void approximate(Eigen::Index channel, const std::vector<Eigen::Index>& targets) {
    const Eigen::MatrixXd& products = materials_.channel(channel).products(threads_);
    for_each_block(
        targets.size(), 1,
        [&](block one) {
          const Eigen::Index target = targets[one.begin];
          std::vector<Eigen::Index> others = columns_of(materials_);
          std::erase(others, target);
          const solution found = solver_.solve(leave_one_out(products, target, others));
          weights_[channel].col(target) =
              scatter_columns(found, others, weights_[channel].rows()).weights.template cast<float>();
        },
        threads_);
  }

  measured<Metric> materials_;
  Solver solver_;
  thread_count threads_;
  std::array<Eigen::MatrixXf, 3> weights_;            // column i explains material i
  std::array<std::vector<Eigen::Index>, 3> renewed_;  // materials whose approximations are new
};

}  // namespace detail

/// One correction C_i for each material of a basis, followed by the constant function 1 if
/// `correction_rule::has_constant`. The corrections' metric is linear (Eq. 16).
///
/// A material that is excluded, in the `measured` basis or by `without`, has no correction of its own and is not used
/// to approximate other materials. The corrections hold the materials in memory, because `without` computes
/// approximations again.
///
/// ```cpp
/// const gonio::measured materials{gonio::expand(prior), gonio::log{}};
/// const gonio::correction corrections{materials};
/// const auto fewer = corrections.without({"chrome"});
/// ```
class correction : public material_functions<lin> {
 public:
  /// O(cells materials^2). Throws gonio::error if there are fewer than two materials, or the solver gives up.
  template <error_metric Metric, normal_solver Solver = nnls>
  explicit correction(const measured<Metric>& materials, const correction_rule& rule = {}, const Solver& solver = {},
                      thread_count threads = {})
      : correction(detail::leave_one_out_approximations<Metric, Solver>(materials, solver, threads), rule, nullptr) {}

  /// Returns how the corrections were made and how to apply them.
  [[nodiscard]] const correction_rule& rule() const noexcept { return rule_; }

  /// Returns the corrections without the materials of these names. Computes a correction again if its approximation
  /// used one of these materials, and copies all other corrections. Throws gonio::error for an unknown name, or if
  /// fewer than two materials are left.
  [[nodiscard]] correction without(const std::vector<std::string>& excluded) const { return without_(*this, excluded); }

 private:
  /// Computes the corrections of the materials whose approximations were just computed, and copies all other
  /// corrections from `known`, if given.
  template <class Approximations>
  correction(Approximations approximations, const correction_rule& rule, const correction* known)
      : material_functions<lin>(approximations.materials().names(), approximations.materials().cells(), lin{},
                                tables(approximations, rule, known)),
        rule_(rule) {
    leave_out(approximations.materials().excluded());
    without_ = [shared = std::make_shared<const Approximations>(std::move(approximations))](
                   const correction& all, const std::vector<std::string>& excluded) {
      return correction(shared->without(excluded), all.rule_, &all);
    };
  }

  template <class Approximations>
  [[nodiscard]] static cell_matrix tables(const Approximations& approximations, const correction_rule& rule,
                                          const correction* known) {
    const auto& materials = approximations.materials();
    const Eigen::Index functions = materials.size() + (rule.has_constant ? 1 : 0);
    cell_matrix tables(materials.cells().size(), 3 * functions);
    for_each_block(
        materials.cells().size(), 1024,
        [&](block range) {
          const Eigen::Index begin = range.begin, rows = range.size();
          if (known)
            tables.middleRows(begin, rows) = known->mapped().middleRows(begin, rows);
          else
            tables.middleRows(begin, rows).setOnes();
        },
        approximations.threads());
    approximations.write_factors(rule.factor, tables, functions);
    return tables;
  }

  correction_rule rule_;
  /// Implements `without`. Owns the materials and their approximations, whose type depends on the metric.
  std::function<correction(const correction&, const std::vector<std::string>&)> without_;
};

static_assert(channelwise_basis<correction>);

}  // namespace gonio
