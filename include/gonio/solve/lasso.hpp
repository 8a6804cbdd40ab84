#pragma once
/// Least squares with a penalty on the sum of the weights' magnitudes: Tibshirani, J. Royal Stat. Soc. B 58, 1996
/// (doi:10.1111/j.2517-6161.1996.tb02080.x).

#include <gonio/solve/coordinate_descent.hpp>

#include <Eigen/Core>

#include <cmath>
#include <string>
#include <vector>

namespace gonio {

/// The smallest lambda at which all weights of all right-hand sides are zero.
[[nodiscard]] double largest_lambda(const normal_equations& normal, sign_rule signs);

namespace detail {

void require_penalty(double lambda);

}  // namespace detail

/// Minimises 1/2 |W^(1/2) (A x - b)|^2 + lambda |x|_1, exactly: coordinate descent finds the support, an active set the
/// weights. lambda is in the units of A'Wb. Throws gonio::error if no optimum can be certified, by the rows where there
/// are rows (solve/signed_solution.hpp).
template <sign_rule Signs>
class basic_lasso {
 public:
  static constexpr bool non_negative = Signs == sign_rule::non_negative;
  using iteration = coordinate_descent<Signs>;

  /// Throws gonio::error unless lambda is finite and not negative. Zero is least squares (NNLS if x >= 0) with as few
  /// independent columns as it needs.
  explicit basic_lasso(double lambda) : lambda_(lambda) { detail::require_penalty(lambda); }

  [[nodiscard]] double lambda() const noexcept { return lambda_; }

  [[nodiscard]] solution solve(const least_squares_problem& problem) const { return solve_any(problem); }
  [[nodiscard]] solution solve(const normal_equations& normal) const { return solve_any(normal); }

 private:
  template <quadratic_problem Problem>
  [[nodiscard]] solution solve_any(const Problem& problem) const;

  double lambda_;
};

using lasso = basic_lasso<sign_rule::any>;
using non_negative_lasso = basic_lasso<sign_rule::non_negative>;

static_assert(normal_solver<lasso> && normal_solver<non_negative_lasso>);

/// Solutions for falling penalties, each started from the last: the regularisation path.
struct lasso_path {
  std::vector<double> lambdas;
  std::vector<solution> solutions;
};

/// `count` penalties in geometric progression from `largest_lambda` down to `smallest_share` of it.
[[nodiscard]] std::vector<double> lambda_sequence(const normal_equations& normal, Eigen::Index count = 50,
                                                  double smallest_share = 1e-3, sign_rule signs = sign_rule::any);

/// Solves for each penalty, starting from the solution of the one before. Best given falling. `problem` is a
/// least_squares_problem or normal_equations. Throws gonio::error for a penalty that `basic_lasso` refuses, or if an
/// optimum is not found.
template <sign_rule Signs = sign_rule::any, quadratic_problem Problem>
[[nodiscard]] lasso_path solve_lasso_path(const Problem& problem, std::vector<double> lambdas);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/lasso.ipp>
#endif
