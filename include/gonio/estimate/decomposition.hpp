#pragma once
/// Basis decomposition: the mapped measurements as a linear combination of a basis' functions.
/// Nielsen et al. 2015, Eq. 9-12 (pca x log-relative x Tikhonov); Noell et al. 2014, Eq. 7-11 (measured x log x NNLS).

#include <gonio/basis/basis.hpp>
#include <gonio/estimate/estimator.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/solve/solver.hpp>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace gonio {

/// Do the weights that a solver finds mean something with a basis? Weights that cannot be negative do not where the
/// functions' signs are arbitrary: principal components want `tikhonov`, `least_squares`, `truncated_svd` or `lasso`;
/// non-negative solvers want measured materials.
template <class Basis, class Solver>
concept meaningful_weights = !(has_arbitrary_sign<Basis> && solves_non_negative<Solver>);

/// Fits each colour channel of measurements by a basis, with the weights found by a solver.
///
/// ```cpp
/// const auto paint = gonio::decomposition{prior, gonio::tikhonov{40.0}}.fit(samples);
/// const auto lc = gonio::decomposition{gonio::measured{materials, gonio::log{}}, gonio::nnls{}}.fit(samples);
/// ```
/// Row i of the system is the basis interpolated at sample i, the right-hand side the sample's mapped value minus the
/// offset there; the sample's weight multiplies its squared error. Channels with a basis in common share one system
/// matrix, others are solved in parallel. Rows are read from the basis block by block, never copied as a whole.
template <colour_basis Basis, solver Solver>
requires meaningful_weights<Basis, Solver>
class decomposition {
 public:
  explicit decomposition(Basis basis, Solver solver = Solver(), thread_count threads = {})
      : basis_(std::move(basis)), solver_(std::move(solver)), threads_(threads) {}

  /// Cost of the solver plus O(samples x size of the basis) for reading the rows; O(samples x size^2) more where the
  /// solver wants the normal equations. Throws gonio::error for unusable samples, or if the solver gives up.
  template <sample_range Samples>
  [[nodiscard]] fitted_brdf<Basis> fit(const Samples& samples) const {
    return solve(measurements_of(samples));
  }

  /// Fits a table: each of its cells is a sample of weight 1.
  [[nodiscard]] fitted_brdf<Basis> fit(const brdf_table& table) const { return solve(measurements_of(table)); }

  /// The least-squares problem that `fit` solves: of one channel, or of all three where they share a basis.
  template <class Measurements>
  [[nodiscard]] least_squares_problem assemble(const Measurements& measured, std::size_t channel = 0) const {
    const auto shared = std::make_shared<const measurements>(measurements_of(measured));
    return problem(shared, channel);
  }

 private:
  /// Where was measured, and what.
  struct measurements {
    std::vector<location> at;
    Eigen::MatrixXd values;  // n x 3, sr^-1
    Eigen::VectorXd weights;
  };

  template <sample_range Samples>
  [[nodiscard]] measurements measurements_of(const Samples& samples) const {
    require_usable(samples);
    const auto count = std::ranges::distance(samples);
    measurements result;
    result.at.reserve(static_cast<std::size_t>(count));
    result.values.resize(count, 3);
    result.weights.resize(count);
    Eigen::Index i = 0;
    for (const sample& s : samples) {
      result.at.push_back(locate(basis_.cells(), s.angles));
      result.values.row(i) = s.value.matrix().transpose();
      result.weights[i++] = s.weight;
    }
    return result;
  }

  [[nodiscard]] measurements measurements_of(const brdf_table& table) const {
    const valid_cells& cells = table.cells();
    const bool own = cells == basis_.cells();
    const auto count = static_cast<Eigen::Index>(cells.size());
    measurements result{std::vector<location>(cells.size()), Eigen::MatrixXd(count, 3), Eigen::VectorXd::Ones(count)};
    for_each_block(
        cells.size(), 4096,
        [&](block range) {
          for (std::size_t cell = range.begin; cell < range.end; ++cell) {
            result.at[cell] = own ? locate_cell(cells, cell) : locate(basis_.cells(), cells.angles(cell));
            result.values.row(static_cast<Eigen::Index>(cell)) = table.at(cell).matrix().transpose();
          }
        },
        threads_);
    return result;
  }

  [[nodiscard]] fitted_brdf<Basis> solve(measurements measured) const {
    const auto shared = std::make_shared<const measurements>(std::move(measured));
    const std::vector<Eigen::Index> columns = columns_of(basis_);
    const auto solve_columns = [&](std::size_t channel) {
      const least_squares_problem whole = problem(shared, channel);
      const bool all = columns.size() == static_cast<std::size_t>(whole.unknowns());
      return solver_.solve(all ? whole : whole.subset(columns));
    };
    if constexpr (basis<Basis>) {
      return {basis_, spread(solve_columns(0), columns, static_cast<Eigen::Index>(basis_.size()))};
    } else {
      std::array<solution, 3> found;
      for_each_block(
          3, 1, [&](block channel) { found[channel.begin] = solve_columns(channel.begin); }, threads_);
      return {basis_, spread(side_by_side(found), columns, static_cast<Eigen::Index>(basis_.size()))};
    }
  }

  /// The system of one channel, or of all if they have the basis in common.
  [[nodiscard]] least_squares_problem problem(const std::shared_ptr<const measurements>& measured,
                                              std::size_t channel) const {
    const auto functions = channel_of(basis_, channel);
    const auto count = static_cast<Eigen::Index>(measured->at.size());
    constexpr Eigen::Index channels = basis<Basis> ? 3 : 1;
    Eigen::MatrixXd mapped(count, channels);
    for_each_block(
        measured->at.size(), 4096,
        [&](block range) {
          for (std::size_t i = range.begin; i < range.end; ++i) {
            const location& at = measured->at[i];
            const double offset = offset_at(functions, at);
            for (Eigen::Index c = 0; c < channels; ++c) {
              const double value =
                  measured->values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(channel) + c);
              mapped(static_cast<Eigen::Index>(i), c) = functions.metric().forward(value, at) - offset;
            }
          }
        },
        threads_);
    const row_source rows{
        count, static_cast<Eigen::Index>(functions.size()), [functions, measured](block range, row_block out) {
          for (std::size_t i = range.begin; i < range.end; ++i)
            read_row_at(functions, measured->at[i], out.row(static_cast<Eigen::Index>(i - range.begin)));
        }};
    return {rows, std::move(mapped), measured->weights, threads_};
  }

  Basis basis_;
  Solver solver_;
  thread_count threads_;
};

}  // namespace gonio
