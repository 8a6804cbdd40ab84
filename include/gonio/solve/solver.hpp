#pragma once
/// The concept of a solver, and what it returns.

#include <gonio/solve/least_squares_problem.hpp>

#include <Eigen/Core>

#include <concepts>

namespace gonio {

/// What a solver found, one column or entry for each right-hand side of the problem.
struct solution {
  Eigen::MatrixXd weights;      ///< k x r
  Eigen::VectorXd residual;     ///< weighted norm of A x - b
  Eigen::VectorXd certificate;  ///< violation of the solver's own optimality (KKT) conditions, relative to |A'Wb|
  int iterations = 0;           ///< 0 for a direct solver
};

/// Finds the weights of a least-squares problem under the solver's own penalty or constraints.
///
/// What the compiler cannot check, and a model must keep: the certificate is computed from the problem and
/// the returned weights, not from the solver's internal state, and is at most about 1e-9 on success; a
/// solver that gives up throws gonio::error; solving is const and thread safe.
///
/// ```cpp
/// struct ordinary_least_squares {
///   gonio::solution solve(const gonio::least_squares_problem& problem) const {
///     const auto& [gram, moment] = problem.normal();
///     const Eigen::MatrixXd x = gram.ldlt().solve(moment);
///     return {x, problem.residual(x), gonio::stationarity(gram * x - moment, moment), 0};
///   }
/// };
/// static_assert(gonio::solver<ordinary_least_squares>);
/// ```
template <class Solver>
concept solver = requires(const Solver& candidate, const least_squares_problem& problem) {
  { candidate.solve(problem) } -> std::same_as<solution>;
};

/// The largest entry of each column of a gradient, relative to the largest of the column of A'Wb.
[[nodiscard]] inline Eigen::VectorXd stationarity(const Eigen::MatrixXd& gradient, const Eigen::MatrixXd& moment) {
  Eigen::VectorXd violation(gradient.cols());
  for (Eigen::Index column = 0; column < gradient.cols(); ++column) {
    const double scale = moment.col(column).cwiseAbs().maxCoeff();
    violation[column] = gradient.col(column).cwiseAbs().maxCoeff() / (scale > 0.0 ? scale : 1.0);
  }
  return violation;
}

}  // namespace gonio
