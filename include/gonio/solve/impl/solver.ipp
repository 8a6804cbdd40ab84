#pragma once
/// Bodies of solve/solver.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/kkt.hpp>
#include <gonio/solve/least_squares_problem.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

#include <concepts>
#include <span>
#include <utility>

namespace gonio {

GONIO_INLINE solution side_by_side(std::span<const solution> parts) {
  Eigen::Index columns = 0;
  for (const solution& part : parts) columns += part.weights.cols();
  solution all{Eigen::MatrixXd(parts.front().weights.rows(), columns), Eigen::VectorXd(columns),
               Eigen::VectorXd(columns), Eigen::VectorXd(columns)};
  Eigen::Index first = 0;
  for (const solution& part : parts) {
    const Eigen::Index count = part.weights.cols();
    all.weights.middleCols(first, count) = part.weights;
    all.residual.segment(first, count) = part.residual;
    all.objective.segment(first, count) = part.objective;
    all.certificate.segment(first, count) = part.certificate;
    all.iterations += part.iterations;
    first += count;
  }
  return all;
}

GONIO_INLINE solution spread(solution found, std::span<const Eigen::Index> columns, Eigen::Index unknowns) {
  if (found.weights.rows() == unknowns) return found;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(unknowns, found.weights.cols());
  for (std::size_t i = 0; i < columns.size(); ++i)
    all.row(columns[i]) = found.weights.row(static_cast<Eigen::Index>(i));
  found.weights = std::move(all);
  return found;
}

}  // namespace gonio

namespace gonio {

GONIO_INLINE solution with_residual_of_rows(solution found, const least_squares_problem& problem) {
  found.residual = problem.residual(found.weights);
  return found;
}

}  // namespace gonio
