#pragma once
/// Bodies of solve/nnls_coordinate_descent.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/coordinate_descent.hpp>
#include <gonio/solve/nnls_coordinate_descent.hpp>

namespace gonio {

GONIO_INLINE solution nnls_coordinate_descent::solve(const least_squares_problem& problem) const {
  const auto start = [&](Eigen::Index column) { return iteration(problem.normal(), column); };
  return solve_signed<sign_rule::non_negative>(problem, 0.0, "projected coordinate descent", start);
}

GONIO_INLINE solution nnls_coordinate_descent::solve(const normal_equations& normal) const {
  const auto start = [&](Eigen::Index column) { return iteration(normal, column); };
  return solve_signed<sign_rule::non_negative>(normal, 0.0, "projected coordinate descent", start);
}

}  // namespace gonio
