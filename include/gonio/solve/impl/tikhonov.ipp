#pragma once
/// Bodies of solve/tikhonov.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/thin_product.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace gonio {

namespace detail {

/// The rows of |W^(1/2) (A x - b)|^2 + eta |x|^2.
struct ridge_rows {
  Eigen::MatrixXd rows;   ///< W^(1/2) A, n x k
  Eigen::MatrixXd right;  ///< W^(1/2) b, n x r
  double eta = 0.0;

  [[nodiscard]] Eigen::MatrixXd misfit(const Eigen::MatrixXd& x) const { return thin_product(rows, x) - right; }
  /// A'W(A x - b) + eta x, which vanishes at the optimum, without the k x k Gram matrix.
  [[nodiscard]] Eigen::MatrixXd gradient(const Eigen::MatrixXd& misfit, const Eigen::MatrixXd& x) const {
    Eigen::MatrixXd sum = thin_transposed_product(rows, misfit);
    sum += eta * x;
    return sum;
  }
};

[[nodiscard]] inline double largest_magnitude(const Eigen::MatrixXd& matrix, Eigen::Index column) {
  double largest = 0.0;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) largest = std::max(largest, std::abs(matrix(row, column)));
  return largest;
}

[[nodiscard]] GONIO_INLINE solution certified(const ridge_rows& ridge, Eigen::MatrixXd x) {
  const Eigen::MatrixXd misfit = ridge.misfit(x), gradient = ridge.gradient(misfit, x),
                        moment = thin_transposed_product(ridge.rows, ridge.right);
  const Eigen::VectorXd nothing(x.cols());
  solution found{std::move(x), nothing, nothing, nothing};
  for (Eigen::Index column = 0; column < misfit.cols(); ++column) {
    const double squares = misfit.col(column).squaredNorm();
    found.residual[column] = std::sqrt(squares);
    found.objective[column] =
        0.5 * (squares - ridge.right.col(column).squaredNorm() + ridge.eta * found.weights.col(column).squaredNorm());
    const double scale = largest_magnitude(moment, column);
    found.certificate[column] = largest_magnitude(gradient, column) / (scale > 0.0 ? scale : 1.0);
  }
  return found;
}

[[nodiscard]] GONIO_INLINE solution solve_dual_ridge(const least_squares_problem& problem, double eta) {
  const ridge_rows ridge{problem.weighted_rows(), problem.weighted_right_hand_side(), eta};
  Eigen::MatrixXd penalised = product_with_transpose(ridge.rows);
  for (Eigen::Index i = 0; i < penalised.rows(); ++i) penalised(i, i) += eta;
  const cholesky factors(penalised);
  Eigen::MatrixXd x = thin_transposed_product(ridge.rows, factors.solve(ridge.right));
  // A step of Newton, with the inverse of A~'A~ + eta I through the dual (Woodbury): if eta is small and rows depend
  // on each other, A~' times a large dual solution has lost digits.
  Eigen::MatrixXd step = ridge.gradient(ridge.misfit(x), x);
  step -= thin_transposed_product(ridge.rows, factors.solve(thin_product(ridge.rows, step)));
  x -= (1.0 / eta) * step;
  return certified(ridge, std::move(x));
}

}  // namespace detail

GONIO_INLINE tikhonov::tikhonov(double eta, form solved_as) : eta_(eta), form_(solved_as) {
  if (!(eta > 0.0 && std::isfinite(eta)))
    throw error{"the penalty eta of a Tikhonov solver must be positive and finite, not ", eta};
}

GONIO_INLINE solution tikhonov::solve(const least_squares_problem& problem) const {
  const bool wide = problem.equations() < problem.unknowns();
  if (form_ == form::dual || (form_ == form::automatic && wide)) return detail::solve_dual_ridge(problem, eta_);
  return with_residual_of_rows(solve(problem.normal()), problem);
}

GONIO_INLINE solution tikhonov::solve(const normal_equations& normal) const {
  Eigen::MatrixXd penalised = normal.gram();
  for (Eigen::Index i = 0; i < penalised.rows(); ++i) penalised(i, i) += eta_;
  const normal_equations ridge(std::move(penalised), normal.moment());
  const Eigen::MatrixXd x = cholesky(ridge.gram()).solve(ridge.moment());
  return {x, normal.residual(x), ridge.objective(x), stationarity(ridge, x)};
}

}  // namespace gonio
