#pragma once
/// Bodies of shape/assignment.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/assignment.hpp>

#include <Eigen/Core>
#include <dlib/optimization/max_cost_assignment.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace gonio::shape::detail {

/// Converts costs to 2^40 integer steps between the smallest and the largest, with opposite sign because dlib
/// maximises. Pads with rows or columns of zeros to a square; an element assigned to the padding has no partner.
[[nodiscard]] GONIO_INLINE dlib::matrix<std::int64_t> integer_gains(const Eigen::MatrixXd& costs) {
  constexpr double steps = 0x1p40;
  const auto size = static_cast<long>(std::max(costs.rows(), costs.cols()));
  dlib::matrix<std::int64_t> gains(size, size);
  gains = 0;
  // Halving keeps the range of finite costs finite.
  const double least = 0.5 * costs.minCoeff(), range = 0.5 * costs.maxCoeff() - least;
  if (!(range > 0.0)) return gains;
  for (Eigen::Index j = 0; j < costs.cols(); ++j)
    for (Eigen::Index i = 0; i < costs.rows(); ++i)
      gains(i, j) = -std::llround((0.5 * costs(i, j) - least) / range * steps);
  return gains;
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE std::vector<Eigen::Index> optimal_assignment(const Eigen::MatrixXd& costs) {
  for (Eigen::Index j = 0; j < costs.cols(); ++j)
    for (Eigen::Index i = 0; i < costs.rows(); ++i)
      if (!std::isfinite(costs(i, j))) refuse({"the cost of assigning row ", i, " to column ", j, " is not finite"});
  std::vector<Eigen::Index> columns(costs.rows(), -1);
  if (costs.size() == 0) return columns;
  const std::vector<long> found = dlib::max_cost_assignment(detail::integer_gains(costs));
  for (Eigen::Index row = 0; row < std::ssize(columns); ++row)
    if (found[row] < costs.cols()) columns[row] = found[row];
  return columns;
}

}  // namespace gonio::shape
