#pragma once
/// Bodies of solve/nnls.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/active_set.hpp>
#include <gonio/solve/nnls.hpp>

namespace gonio {

GONIO_INLINE solution nnls::solve(const least_squares_problem& problem) const {
  const auto start = [&](Eigen::Index column) { return iteration(problem.normal(), column); };
  return solve_signed<sign_rule::non_negative>(problem, 0.0, "NNLS", start);
}

GONIO_INLINE solution nnls::solve(const normal_equations& normal) const {
  const auto start = [&](Eigen::Index column) { return iteration(normal, column); };
  return solve_signed<sign_rule::non_negative>(normal, 0.0, "NNLS", start);
}

}  // namespace gonio
