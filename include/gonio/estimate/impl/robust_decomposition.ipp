#pragma once
/// Bodies of estimate/robust_decomposition.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/robust_decomposition.hpp>

#include <cmath>
#include <vector>

namespace gonio {

GONIO_INLINE Eigen::VectorXd limit_outliers(const Eigen::VectorXd& inlier_weights) {
  const Eigen::Index n = inlier_weights.size();
  if (n == 0) return inlier_weights;
  const auto most = static_cast<Eigen::Index>(largest_outlier_share(n) * static_cast<double>(n));
  std::vector<double> sorted(inlier_weights.begin(), inlier_weights.end());
  const double least_inlier = nth_smallest(sorted, most);
  if (!(least_inlier > 0.0)) return Eigen::VectorXd::Ones(n);
  return (inlier_weights / least_inlier).cwiseMin(1.0);
}

}  // namespace gonio
