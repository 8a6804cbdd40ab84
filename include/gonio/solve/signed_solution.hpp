#pragma once
/// What makes sure of the weights of NNLS and Lasso solvers, whichever way they were found.
///
/// Normal equations square the condition number: they hold the problem of its rows only as long as
/// epsilon |x| / sigma is small, for columns of length 1, |b| = 1 and sigma the least singular value of the columns
/// that matter (Golub and Van Loan, Matrix Computations, 4th ed., 5.3.7). Weights that cannot be trusted are found
/// again by an orthogonal factorisation of the rows where there are rows, and by the quadratic program where there are
/// none.

#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

#include <string>

namespace gonio::detail {

/// min 1/2 x'Q x - m'x + lambda |x|_1, with or without x >= 0, and who was asked for it.
struct signed_task {
  sign_rule signs = sign_rule::non_negative;
  double lambda = 0.0;
  std::string method;  ///< as messages name it
};

/// Weights at which a solver arrived (not a number where it did not), as a solution. Those of a right-hand side are
/// found again unless
/// - their KKT residual is at most 1e-9,
/// - the objective is in [-b'Wb/2, 0] but for rounding: no weights explain more than all, and those of zero are
/// allowed,
/// - rounding of the weights alone moves A x by less than 1e-5 |b| (larger weights certify themselves, since a
///   KKT residual is relative to them).
/// Throws gonio::error naming the method if that does not help.
[[nodiscard]] solution certified(const normal_equations& normal, const signed_task& task, Eigen::MatrixXd weights);

/// The same of a problem that has rows, whose residual it has. Beyond that the objective of the normal equations must
/// agree with that of the rows to 1e-9 b'Wb / 2, the weights' gradient rule out that the optimum is lower by more than
/// that, and `is_resolved`. O(n k) for n rows, and O(n k^2) where the rows are
/// factorised.
[[nodiscard]] solution certified(const least_squares_problem& problem, const signed_task& task,
                                 Eigen::MatrixXd weights);

/// Do the normal equations hold enough digits of their rows to find the optimum with an objective that is off by at
/// most about 1e-10 b'Wb? They do not if columns that have a weight, or whose gradient is within 1e-9 |b| of giving
/// them one, depend on each other but for rounding: weights may then be as large as 1e8 |b| for what nobody sees in Q.
/// Large weights are impossible, and all is well, under a large enough penalty, or if x >= 0 and these columns have no
/// negative product. `normal` has the energy of its right-hand sides.
[[nodiscard]] bool is_resolved(const normal_equations& normal, Eigen::Index right_hand_side,
                               const Eigen::VectorXd& weights, const signed_task& task);

}  // namespace gonio::detail

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/signed_solution.ipp>
#endif
