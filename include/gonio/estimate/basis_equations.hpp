#pragma once
/// The least-squares problems that fitting measurements by a basis amounts to.
/// Nielsen et al. 2015, Eq. 9; Noell, Koehler and Stricker 2014, Eq. 7.

#include <gonio/basis/basis.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/solve/solver.hpp>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace gonio {

/// Measurements seen through a basis. Row i of a system is the basis interpolated at measurement i, the right-hand side
/// its mapped value minus the offset there; its weight multiplies the squared error. Channels with a basis in common
/// share one system, with a right-hand side for each. Rows are read from the basis block by block, never copied as a
/// whole.
template <colour_basis Basis>
class basis_equations {
 public:
  /// Systems to solve: one if the channels share their basis, else three.
  static constexpr std::size_t systems = basis<Basis> ? 1 : 3;

  basis_equations(Basis functions, located_samples samples, thread_count threads = {})
      : basis_(std::move(functions)),
        measured_(std::make_shared<const located_samples>(std::move(samples))),
        threads_(threads) {}

  /// Of whatever `locate_samples` takes for the basis' domain: samples (throws gonio::error for unusable ones) or a
  /// table, each cell of which is one.
  template <class Samples>
  basis_equations(Basis functions, const Samples& samples, thread_count threads = {})
      : basis_equations(functions, locate_samples(functions.cells(), samples, threads), threads) {}

  /// The system of one channel, or of all if they have the basis in common, over all functions of the basis.
  [[nodiscard]] least_squares_problem problem(std::size_t channel = 0) const {
    const auto functions = channel_of(basis_, channel);
    const std::shared_ptr<const located_samples> measured = measured_;
    const row_source rows{static_cast<Eigen::Index>(measured->at.size()), static_cast<Eigen::Index>(functions.size()),
                          [functions, measured](block range, row_block out) {
                            for (std::size_t i = range.begin; i < range.end; ++i)
                              read_row_at(functions, measured->at[i],
                                          out.row(static_cast<Eigen::Index>(i - range.begin)));
                          }};
    return {rows, mapped(functions, static_cast<Eigen::Index>(channel)), measured->weights, threads_};
  }

  /// The weights of all functions, size() x channels, by `solver(problem)` for each system, which returns a solution;
  /// functions that the basis leaves out have weight zero. Systems are solved in parallel.
  template <class Solve>
  [[nodiscard]] solution solve(const Solve& solver) const {
    const std::vector<Eigen::Index> columns = columns_of(basis_);
    const auto unknowns = static_cast<Eigen::Index>(basis_.size());
    std::array<solution, systems> found;
    for_each_block(
        systems, 1,
        [&](block system) {
          const least_squares_problem whole = problem(system.begin);
          const bool all = static_cast<Eigen::Index>(columns.size()) == unknowns;
          found[system.begin] = solver(all ? whole : whole.subset(columns));
        },
        threads_);
    return spread(side_by_side(found), columns, unknowns);
  }

 private:
  template <class Functions>
  [[nodiscard]] Eigen::MatrixXd mapped(const Functions& functions, Eigen::Index first) const {
    const Eigen::Index channels = measured_->values.cols() / static_cast<Eigen::Index>(systems);
    Eigen::MatrixXd right(measured_->values.rows(), channels);
    for_each_block(
        measured_->at.size(), 4096,
        [&](block range) {
          for (std::size_t i = range.begin; i < range.end; ++i) {
            const location& at = measured_->at[i];
            const double offset = offset_at(functions, at);
            const auto row = static_cast<Eigen::Index>(i);
            for (Eigen::Index c = 0; c < channels; ++c)
              right(row, c) = functions.metric().forward(measured_->values(row, first + c), at) - offset;
          }
        },
        threads_);
    return right;
  }

  Basis basis_;
  std::shared_ptr<const located_samples> measured_;
  thread_count threads_;
};

}  // namespace gonio
