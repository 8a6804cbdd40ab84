#pragma once
/// Bodies of solve/solver.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/solve/kkt.hpp>
#include <gonio/solve/least_squares_problem.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

namespace gonio {

GONIO_INLINE solution concatenate_columns(std::span<const solution> parts) {
  Eigen::Index columns = 0;
  for (const solution& part : parts) columns += part.weights.cols();
  solution all{Eigen::MatrixXd(parts.front().weights.rows(), columns),
               {Eigen::VectorXd(columns), Eigen::VectorXd(columns), Eigen::VectorXd(columns)}};
  Eigen::Index first = 0;
  for (const solution& part : parts) {
    const Eigen::Index count = part.weights.cols();
    const Eigen::Index unknowns = all.weights.rows();
    std::copy_n(part.weights.data(), unknowns * count, all.weights.data() + unknowns * first);
    std::copy_n(part.report.residual.data(), count, all.report.residual.data() + first);
    std::copy_n(part.report.objective.data(), count, all.report.objective.data() + first);
    std::copy_n(part.report.kkt_residual.data(), count, all.report.kkt_residual.data() + first);
    all.report.iterations += part.report.iterations;
    first += count;
  }
  return all;
}

GONIO_INLINE solution scatter_columns(solution found, std::span<const Eigen::Index> columns, Eigen::Index unknowns) {
  if (found.weights.rows() == unknowns) return found;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(unknowns, found.weights.cols());
  for (Eigen::Index side = 0; side < all.cols(); ++side)
    for (Eigen::Index i = 0; i < std::ssize(columns); ++i) all(columns[i], side) = found.weights(i, side);
  found.weights = std::move(all);
  return found;
}

GONIO_INLINE solution with_residual_of_rows(solution found, const least_squares_problem& problem) {
  found.report.residual = problem.residual(found.weights);
  return found;
}

GONIO_INLINE solution detail::require_certified(solution found, std::string_view solver) {
  for (Eigen::Index column = 0; column < found.report.kkt_residual.size(); ++column)
    if (!(found.report.kkt_residual[column] <= kkt_residual_limit))
      refuse({solver, " has found no optimum of right-hand side ", column,
              ": the problem is too ill-conditioned for double precision"});
  return found;
}

}  // namespace gonio
