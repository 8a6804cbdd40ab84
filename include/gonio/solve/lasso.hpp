#pragma once
/// Least squares with a penalty on the sum of the weights' magnitudes: Tibshirani, J. Royal Stat. Soc. B 58, 1996
/// (doi:10.1111/j.2517-6161.1996.tb02080.x).

#include <gonio/solve/coordinate_descent.hpp>

#include <Eigen/Core>

#include <cmath>

namespace gonio {

/// Returns the smallest lambda at which all weights of all right-hand sides are zero.
[[nodiscard]] double largest_lambda(const normal_equations& normal, sign_rule signs);

namespace detail {

void require_penalty(double lambda);

}  // namespace detail

/// Minimises 1/2 |W^(1/2) (A x - b)|^2 + lambda |x|_1 exactly. Coordinate descent finds the support (the non-zero
/// weights), and an active-set method its weights. lambda is in the units of A'Wb. Throws gonio::error if no optimum
/// can be certified; certification uses the rows if there are any (solve/signed_solution.hpp).
template <sign_rule Signs>
class basic_lasso {
 public:
  static constexpr bool non_negative = Signs == sign_rule::non_negative;
  using iteration = coordinate_descent<Signs>;

  /// Throws gonio::error unless lambda is finite and not negative. If lambda is 0, minimises least squares (NNLS if x
  /// >= 0), with weights on independent columns only.
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

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/lasso.ipp>
#endif
