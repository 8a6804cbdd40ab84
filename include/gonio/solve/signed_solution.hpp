#pragma once
/// Certifies the weights of NNLS and Lasso solvers, independently of the solver.
///
/// Normal equations square the condition number. They represent the problem of their rows only if epsilon |x| / sigma
/// is small. Here columns are scaled to length 1 and |b| to 1; sigma is the smallest singular value of the relevant
/// columns (Golub and Van Loan, Matrix Computations, 4th ed., 5.3.7). Weights that fail the tests are computed again,
/// from an orthogonal factorisation of the rows if there are rows, otherwise by the quadratic program.

#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

#include <string>

namespace gonio::detail {

/// The problem min 1/2 x'Q x - m'x + lambda |x|_1, with or without x >= 0, and the method that was asked to solve it.
struct signed_task {
  sign_rule signs = sign_rule::non_negative;
  double lambda = 0.0;
  std::string method;  ///< name of the method in messages
};

/// Makes a solution from the weights that a solver found (NaN if the solver failed). The weights of a right-hand side
/// are computed again unless
/// - their KKT residual is at most 1e-12,
/// - the objective is in [-b'Wb/2, 0] except for rounding: weights cannot explain more than all of b, and weights of
///   zero are allowed,
/// - rounding the weights moves A x by less than 1e-5 |b| (larger weights would always pass the first test, because a
///   KKT residual is relative to the weights). Throws gonio::error naming the method if the new weights fail, too.
[[nodiscard]] solution certified(const normal_equations& normal, const signed_task& task, Eigen::MatrixXd weights);

/// Makes a solution from the weights of a problem with rows, and computes the residual from the rows. In addition to
/// the tests for normal equations, requires that the objective of the normal equations agrees with that of the rows to
/// 1e-9 b'Wb / 2, that the gradient excludes an optimum that is lower by more than that, and that `is_resolved` returns
/// true. O(n k) for n rows and k columns, and O(n k^2) if the rows are factorised.
[[nodiscard]] solution certified(const least_squares_problem& problem, const signed_task& task,
                                 Eigen::MatrixXd weights);

/// Returns true if the normal equations determine the optimum with an error of the objective of at most about 1e-10
/// b'Wb. They do not if some columns depend on each other up to rounding, and these columns have a weight, or a
/// gradient within 1e-9 |b| of getting a weight. Such weights may be as large as 1e8 |b|, although Q does not determine
/// them. Large weights are impossible under a large enough penalty, or if x >= 0 and these columns have no negative
/// product. `normal` must have the squared norms of its right-hand sides.
[[nodiscard]] bool is_resolved(const normal_equations& normal, Eigen::Index right_hand_side,
                               const Eigen::VectorXd& weights, const signed_task& task);

}  // namespace gonio::detail

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/signed_solution.ipp>
#endif
