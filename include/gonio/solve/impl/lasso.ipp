#pragma once
/// Bodies of solve/lasso.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/coordinate_descent.hpp>
#include <gonio/solve/lasso.hpp>

#include <cmath>
#include <string>
#include <vector>

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

GONIO_INLINE std::vector<double> lambda_sequence(const normal_equations& normal, Eigen::Index count,
                                                 double smallest_share, sign_rule signs) {
  if (count < 2) refuse({"a regularisation path needs at least two penalties, not ", count});
  if (!(smallest_share > 0.0 && smallest_share < 1.0))
    refuse({"the smallest penalty of a path must be a share in (0, 1) of the largest, not ", smallest_share});
  const double largest = largest_lambda(normal, signs);
  std::vector<double> lambdas(count);
  for (Eigen::Index i = 0; i < count; ++i)
    lambdas[i] = largest * std::pow(smallest_share, static_cast<double>(i) / static_cast<double>(count - 1));
  return lambdas;
}

}  // namespace gonio

namespace gonio {

template <sign_rule Signs>
template <quadratic_problem Problem>
solution basic_lasso<Signs>::solve_any(const Problem& problem) const {
  const auto start = [&](Eigen::Index column) { return iteration(problem.normal(), column, lambda_); };
  return solve_signed<Signs>(problem, lambda_, "the Lasso", start);
}

template <sign_rule Signs, quadratic_problem Problem>
lasso_path solve_lasso_path(const Problem& problem, std::vector<double> lambdas) {
  const normal_equations& normal = problem.normal();
  lasso_path path{std::move(lambdas), {}};
  Eigen::MatrixXd last = Eigen::MatrixXd::Zero(normal.unknowns(), normal.right_hand_sides());
  for (const double lambda : path.lambdas) {
    detail::require_penalty(lambda);
    const auto warm = [&](Eigen::Index column) {
      active_set<Signs> run(normal, column, lambda);
      run.start_from(last.col(column));
      return run;
    };
    path.solutions.push_back(solve_signed<Signs>(problem, lambda, "the Lasso path", warm));
    last = path.solutions.back().weights;
  }
  return path;
}

}  // namespace gonio
