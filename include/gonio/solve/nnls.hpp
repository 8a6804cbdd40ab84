#pragma once
/// Non-negative least squares by the active-set method of Lawson and Hanson (1974) on the normal equations
/// (Bro and de Jong 1997). With measured materials as columns it is the initial estimate of Noell et al. 2014.

#include <gonio/solve/active_set.hpp>

namespace gonio {

/// Minimises |W^(1/2) (A x - b)|^2 over x >= 0. Throws gonio::error if it does not end within 10 k + 100 steps.
///
/// ```cpp
/// const gonio::solution found = gonio::nnls().solve(problem);   // a least_squares_problem, or normal_equations
/// ```
class nnls {
 public:
  static constexpr bool non_negative = true;
  using iteration = active_set<sign_rule::non_negative>;

  template <quadratic_problem Problem = least_squares_problem>
  [[nodiscard]] solution solve(const Problem& problem) const {
    const normal_equations& normal = problem.normal();
    const int limit = static_cast<int>(10 * normal.unknowns() + 100);
    solution found =
        solve_by_iteration(problem, limit, "NNLS", [&](Eigen::Index column) { return iteration(normal, column); });
    found.objective = normal.objective(found.weights);
    found.certificate = kkt_violation(normal, found.weights, 0.0, sign_rule::non_negative);
    return found;
  }
};

static_assert(normal_solver<nnls>);

}  // namespace gonio
