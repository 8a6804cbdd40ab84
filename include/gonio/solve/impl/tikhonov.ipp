#pragma once
/// Bodies of solve/tikhonov.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/thin_product.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gonio {

namespace detail {

/// The weighted rows and right-hand sides of the objective |W^(1/2) (A x - b)|^2 + eta |x|^2.
struct ridge_rows {
  Eigen::MatrixXd rows;   ///< W^(1/2) A, n x k
  Eigen::MatrixXd right;  ///< W^(1/2) b, n x r
  double eta = 0.0;

  [[nodiscard]] Eigen::MatrixXd misfit(const Eigen::MatrixXd& x) const {
    Eigen::MatrixXd off = thin_product(rows, x);
    add_scaled(-1.0, right.data(), off.data(), off.size());
    return off;
  }
  /// Returns A'W(A x - b) + eta x, which vanishes at the optimum. Does not need the k x k Gram matrix.
  [[nodiscard]] Eigen::MatrixXd gradient(const Eigen::MatrixXd& misfit, const Eigen::MatrixXd& x) const {
    Eigen::MatrixXd sum = thin_transposed_product(rows, misfit);
    add_scaled(eta, x.data(), sum.data(), sum.size());
    return sum;
  }
};

[[nodiscard]] GONIO_INLINE Eigen::MatrixXd by_columns(const row_matrix& rows) {
  Eigen::MatrixXd copy(rows.rows(), rows.cols());
  for (Eigen::Index column = 0; column < copy.cols(); ++column)
    for (Eigen::Index row = 0; row < copy.rows(); ++row) copy(row, column) = rows(row, column);
  return copy;
}

[[nodiscard]] GONIO_INLINE double squared_norm(const Eigen::MatrixXd& matrix, Eigen::Index column) {
  const double* numbers = matrix.data() + column * matrix.rows();
  return dot(numbers, numbers, matrix.rows());
}

/// Returns the largest magnitude in a column; infinity if a number is not finite, because std::max would ignore NaN.
[[nodiscard]] GONIO_INLINE double largest_magnitude(const Eigen::MatrixXd& matrix, Eigen::Index column) {
  double largest = 0.0;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    if (!std::isfinite(matrix(row, column))) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::abs(matrix(row, column)));
  }
  return largest;
}

[[nodiscard]] GONIO_INLINE solution certified(const ridge_rows& ridge, Eigen::MatrixXd x) {
  const Eigen::MatrixXd misfit = ridge.misfit(x), gradient = ridge.gradient(misfit, x),
                        rhs = thin_transposed_product(ridge.rows, ridge.right);
  const Eigen::VectorXd nothing(x.cols());
  solution found{std::move(x), {nothing, nothing, nothing}};
  for (Eigen::Index column = 0; column < misfit.cols(); ++column) {
    const double squares = squared_norm(misfit, column);
    found.report.residual[column] = std::sqrt(squares);
    found.report.objective[column] =
        0.5 * (squares - squared_norm(ridge.right, column) + ridge.eta * squared_norm(found.weights, column));
    const double scale = largest_magnitude(rhs, column), worst = largest_magnitude(gradient, column);
    found.report.kkt_residual[column] =
        std::isfinite(scale) ? worst / (scale > 0.0 ? scale : 1.0) : std::numeric_limits<double>::infinity();
  }
  return found;
}

[[nodiscard]] GONIO_INLINE solution solve_dual_ridge(const least_squares_problem& problem, double eta) {
  const ridge_rows ridge{by_columns(problem.weighted_rows()), problem.weighted_right_hand_side(), eta};
  Eigen::MatrixXd penalised = product_with_transpose(ridge.rows);
  for (Eigen::Index i = 0; i < penalised.rows(); ++i) penalised(i, i) += eta;
  const cholesky factors(penalised);
  Eigen::MatrixXd x = thin_transposed_product(ridge.rows, factors.solve(ridge.right));
  // Make a Newton step, with the inverse of A~'A~ + eta I through the dual (Woodbury). The step restores digits: if eta
  // is small and rows depend on each other, the product of A~' with a large dual solution loses some.
  Eigen::MatrixXd step = ridge.gradient(ridge.misfit(x), x);
  const Eigen::MatrixXd seen = thin_transposed_product(ridge.rows, factors.solve(thin_product(ridge.rows, step)));
  add_scaled(-1.0, seen.data(), step.data(), step.size());
  add_scaled(-1.0 / eta, step.data(), x.data(), x.size());
  return certified(ridge, std::move(x));
}

}  // namespace detail

GONIO_INLINE tikhonov::tikhonov(double eta, form solved_as) : eta_(eta), form_(solved_as) {
  if (!(eta > 0.0 && std::isfinite(eta)))
    refuse({"the penalty eta of a Tikhonov solver must be positive and finite, not ", eta});
}

GONIO_INLINE solution tikhonov::solve(const least_squares_problem& problem) const {
  const bool wide = problem.equations() < problem.unknowns();
  if (form_ == form::dual || (form_ == form::automatic && wide))
    return detail::require_certified(detail::solve_dual_ridge(problem, eta_), "Tikhonov's solver");
  return with_residual_of_rows(solve(problem.normal()), problem);
}

GONIO_INLINE solution tikhonov::solve(const normal_equations& normal) const {
  Eigen::MatrixXd penalised = normal.gram();
  for (Eigen::Index i = 0; i < penalised.rows(); ++i) penalised(i, i) += eta_;
  const normal_equations ridge(std::move(penalised), normal.rhs());
  const Eigen::MatrixXd x = cholesky(ridge.gram()).solve(ridge.rhs());
  return detail::require_certified({x, {normal.residual(x), ridge.objective(x), stationarity(ridge, x)}},
                                   "Tikhonov's solver");
}

}  // namespace gonio
