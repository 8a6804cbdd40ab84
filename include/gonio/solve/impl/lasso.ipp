#pragma once
/// Bodies of solve/lasso.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/coordinate_descent.hpp>
#include <gonio/solve/lasso.hpp>

#include <cmath>

namespace gonio {

GONIO_INLINE double largest_lambda(const normal_equations& normal, sign_rule signs) {
  double largest = 0.0;
  for (const double rhs : normal.rhs().reshaped())
    largest = std::max(largest, signs == sign_rule::any ? std::abs(rhs) : rhs);
  return largest;
}

}  // namespace gonio

namespace gonio::detail {

GONIO_INLINE void require_penalty(double lambda) {
  if (!(lambda >= 0.0 && std::isfinite(lambda)))
    refuse({"the penalty lambda of a Lasso must be finite and not negative, not ", lambda});
}

}  // namespace gonio::detail

namespace gonio {

template <sign_rule Signs>
template <quadratic_problem Problem>
solution basic_lasso<Signs>::solve_any(const Problem& problem) const {
  const auto start = [&](Eigen::Index column) { return iteration(problem.normal(), column, lambda_); };
  return solve_signed<Signs>(problem, lambda_, "the Lasso", start);
}

}  // namespace gonio
