#pragma once
/// Non-negative least squares by projected coordinate descent (Franc, Hlavac and Navara, CAIP 2005), finished by an
/// active set.

#include <gonio/solve/coordinate_descent.hpp>

namespace gonio {

/// Minimises |W^(1/2) (A x - b)|^2 over x >= 0, as `nnls` does; docs/solvers.md has both measured.
class nnls_coordinate_descent {
 public:
  static constexpr bool non_negative = true;
  using iteration = coordinate_descent<sign_rule::non_negative>;

  template <quadratic_problem Problem = least_squares_problem>
  [[nodiscard]] solution solve(const Problem& problem) const {
    const normal_equations& normal = problem.normal();
    solution found = solve_by_iteration(problem, 100, "projected coordinate descent",
                                        [&](Eigen::Index column) { return iteration(normal, column); });
    found.objective = normal.objective(found.weights);
    found.certificate = kkt_violation(normal, found.weights, 0.0, sign_rule::non_negative);
    return found;
  }
};

static_assert(normal_solver<nnls_coordinate_descent>);

}  // namespace gonio
