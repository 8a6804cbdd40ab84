#pragma once
/// Which of two sets belong together at the least total cost: the linear assignment problem, solved by the Hungarian
/// method (Kuhn, Naval Research Logistics Quarterly 2, 1955) as dlib has it, in O(n^3). Programs that include this link
/// dlib; docs/decisions/0011-assignment.md says why.

#include <gonio/core/error.hpp>

#include <Eigen/Core>
#include <dlib/optimization/max_cost_assignment.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gonio {

namespace detail {

/// 2^40 steps between the least and the largest cost, of opposite sign as dlib maximises, with rows or columns of zeros
/// to make a square: whoever is assigned there is left over, and all pay the same for it.
[[nodiscard]] inline dlib::matrix<std::int64_t> integer_gains(const Eigen::MatrixXd& costs) {
  constexpr double steps = 0x1p40;
  const auto size = static_cast<long>(std::max(costs.rows(), costs.cols()));
  dlib::matrix<std::int64_t> gains(size, size);
  gains = 0;
  // Halves, so that the range of finite numbers is finite.
  const double least = 0.5 * costs.minCoeff(), range = 0.5 * costs.maxCoeff() - least;
  if (!(range > 0.0)) return gains;
  for (Eigen::Index j = 0; j < costs.cols(); ++j)
    for (Eigen::Index i = 0; i < costs.rows(); ++i)
      gains(i, j) = -std::llround((0.5 * costs(i, j) - least) / range * steps);
  return gains;
}

}  // namespace detail

/// For each row the column it is assigned to, no column twice, such that the costs of all assigned pairs have the least
/// sum. As many pairs are made as the shorter side has; rows beyond the number of columns are assigned to -1. Costs of
/// any sign are rounded to a 2^40th of their range, so that the sum is within n / 2^40 of the range of the least one.
/// The time is O(n^3) for the longer side n: 7 ms for 300, 0.1 s for 1000.
///
/// Throws gonio::error for a cost that is not finite.
[[nodiscard]] inline std::vector<Eigen::Index> optimal_assignment(const Eigen::MatrixXd& costs) {
  for (Eigen::Index j = 0; j < costs.cols(); ++j)
    for (Eigen::Index i = 0; i < costs.rows(); ++i)
      if (!std::isfinite(costs(i, j)))
        throw error("the cost of assigning row " + std::to_string(i) + " to column " + std::to_string(j) +
                    " is not finite");
  std::vector<Eigen::Index> columns(static_cast<std::size_t>(costs.rows()), -1);
  if (costs.size() == 0) return columns;
  const std::vector<long> found = dlib::max_cost_assignment(detail::integer_gains(costs));
  for (std::size_t row = 0; row < columns.size(); ++row)
    if (found[row] < costs.cols()) columns[row] = found[row];
  return columns;
}

}  // namespace gonio
