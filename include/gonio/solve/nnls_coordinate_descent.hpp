#pragma once
/// Non-negative least squares by projected coordinate descent (Franc, Hlavac and Navara, CAIP 2005), finished by an
/// active set.

#include <gonio/solve/coordinate_descent.hpp>

namespace gonio {

/// Minimises |W^(1/2) (A x - b)|^2 over x >= 0, as `nnls` does; docs/solvers.md has both measured. It is
/// `non_negative_lasso` without a penalty under the name by which NNLS knows it.
class nnls_coordinate_descent {
 public:
  static constexpr bool non_negative = true;
  using iteration = coordinate_descent<sign_rule::non_negative>;

  template <quadratic_problem Problem = least_squares_problem>
  [[nodiscard]] solution solve(const Problem& problem) const {
    const auto start = [&](Eigen::Index column) { return iteration(problem.normal(), column); };
    return solve_signed<sign_rule::non_negative>(problem, 0.0, "projected coordinate descent", start);
  }
};

static_assert(normal_solver<nnls_coordinate_descent>);

}  // namespace gonio
