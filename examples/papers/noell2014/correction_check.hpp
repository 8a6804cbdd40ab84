#pragma once
/// The expressiveness of correction functions: Noell, Koehler and Stricker 2014, section 2, combine each function from
/// the other functions.

#include <gonio/core/parallel.hpp>
#include <gonio/robust/correction.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <utility>
#include <vector>

namespace papers {

/// Returns the weights, k x 3 for k functions, with which the other functions best describe the function `target`, by a
/// solver of normal equations. The weights of `target` itself are zero. If there is a constant function, it is among
/// the others.
template <gonio::normal_solver Solver>
[[nodiscard]] Eigen::MatrixXd weights_of_others(const gonio::correction& functions, Eigen::Index target,
                                                const Solver& solver, gonio::thread_count threads = {}) {
  std::vector<Eigen::Index> others = gonio::columns_of(functions);
  std::erase(others, target);
  Eigen::MatrixXd weights(functions.size(), 3);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto channel = functions.channel(c);
    const auto found = solver.solve(gonio::leave_one_out(channel.products(threads), target, others));
    weights.col(c) = gonio::scatter_columns(found, others, functions.size()).weights;
  }
  return weights;
}

/// Returns, for each material in use, the mean over all cells and channels of |C - D|. D is the combination of the
/// other functions that best describes the correction function C. O(cells functions^2).
template <gonio::normal_solver Solver>
[[nodiscard]] std::vector<double> deviations_from_others(const gonio::correction& functions, const Solver& solver,
                                                         gonio::thread_count threads = {}) {
  const Eigen::Index materials = std::ssize(functions.names());
  const Eigen::Index size = functions.size();
  std::vector<Eigen::Index> targets = gonio::columns_of(functions);
  std::erase_if(targets, [&](Eigen::Index column) { return column >= materials; });
  std::vector<Eigen::MatrixXd> combinations;
  for (const Eigen::Index target : targets)
    combinations.push_back(weights_of_others(functions, target, solver, threads));
  Eigen::ArrayXd sums = Eigen::ArrayXd::Zero(std::ssize(targets));
  for (std::size_t c = 0; c < 3; ++c) {
    const auto channel = functions.channel(c);
    Eigen::MatrixXf residual(size, std::ssize(targets));  // the functions times these weights are the deviations
    for (std::size_t i = 0; i < targets.size(); ++i) {
      residual.col(i) = -combinations[i].col(c).template cast<float>();
      residual(targets[i], i) = 1.0f;
    }
    const Eigen::ArrayXd zero = Eigen::ArrayXd::Zero(std::ssize(targets));
    sums += gonio::sum_over_blocks(
        functions.cells().size(), 1024, zero,
        [&](Eigen::ArrayXd& sum, gonio::block range) {
          const Eigen::Index begin = range.begin, count = range.size();
          const Eigen::MatrixXf deviations = channel.values().middleRows(begin, count) * residual;
          sum += deviations.cwiseAbs().colwise().sum().transpose().template cast<double>().array();
        },
        threads);
  }
  sums /= 3.0 * static_cast<double>(functions.cells().size());
  return {sums.begin(), sums.end()};
}

}  // namespace papers
