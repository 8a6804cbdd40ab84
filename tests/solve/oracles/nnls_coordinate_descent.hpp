#pragma once
/// Non-negative least squares by projected coordinate descent (Franc, Hlavac and Navara, CAIP 2005), finished by an
/// active set.

#include <gonio/solve/coordinate_descent.hpp>

namespace gonio {

/// Minimises |W^(1/2) (A x - b)|^2 over x >= 0, like `nnls`; docs/results/solvers.md compares both. It is
/// `non_negative_lasso` without a penalty, under its usual name for NNLS. Throws gonio::error in the same cases as
/// `nnls`.
class nnls_coordinate_descent {
 public:
  static constexpr bool non_negative = true;
  using iteration = coordinate_descent<sign_rule::non_negative>;

  [[nodiscard]] solution solve(const least_squares_problem& problem) const;
  [[nodiscard]] solution solve(const normal_equations& normal) const;
};

static_assert(normal_solver<nnls_coordinate_descent>);

}  // namespace gonio

namespace gonio {

inline solution nnls_coordinate_descent::solve(const least_squares_problem& problem) const {
  const auto start = [&](Eigen::Index column) { return iteration(problem.normal(), column); };
  return solve_signed<sign_rule::non_negative>(problem, 0.0, "projected coordinate descent", start);
}

inline solution nnls_coordinate_descent::solve(const normal_equations& normal) const {
  const auto start = [&](Eigen::Index column) { return iteration(normal, column); };
  return solve_signed<sign_rule::non_negative>(normal, 0.0, "projected coordinate descent", start);
}

}  // namespace gonio
