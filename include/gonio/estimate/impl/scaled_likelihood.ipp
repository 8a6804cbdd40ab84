#pragma once
/// Bodies of estimate/scaled_likelihood.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/scaled_likelihood.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace gonio::detail {

GONIO_INLINE scaled_likelihood locate_mixture(const std::vector<double>& differences,
                                              const std::vector<double>& outliers, double start) {
  constexpr int steps = 8;
  constexpr double smallest_scale = 0.02;
  constexpr double nu = outlier_mixture::degrees_of_freedom;
  const Eigen::Index count = std::ssize(differences);
  std::vector<double> tails(count), densities(count);
  outlier_mixture mixture{0.5, 0.3};
  scaled_likelihood found{start};
  for (int step = 0; step < steps; ++step) {
    for (Eigen::Index i = 0; i < count; ++i) tails[i] = mixture.tail_weight(differences[i] - found.logarithm_of_factor);
    double inliers = 0.0, weight = 0.0, squares = 0.0, located = 0.0;
    for (Eigen::Index i = 0; i < count; ++i) {
      const double residual = differences[i] - found.logarithm_of_factor;
      const double inlier = mixture.inlier_fraction * mixture.density_on_tail(tails[i]);
      densities[i] = inlier + (1.0 - mixture.inlier_fraction) * outliers[i];
      const double share = inlier / densities[i], on_tail = share * tails[i];
      inliers += share;
      weight += on_tail;
      squares += (nu + 1.0) / nu * on_tail * residual * residual;
      located += on_tail * differences[i];
    }
    found.logarithm_of_factor = weight > 0.0 ? located / weight : start;
    mixture = {std::clamp(inliers / static_cast<double>(count), 0.05, 0.99),
               std::max(std::sqrt(squares / std::max(inliers, 1e-9)), smallest_scale)};
  }
  take_logarithms(densities.data(), count);
  found.log_likelihood = std::accumulate(densities.begin(), densities.end(), 0.0);
  return found;
}

GONIO_INLINE scaled_likelihood best_factor(const std::vector<double>& differences,
                                           const std::vector<double>& outliers) {
  std::vector<double> sorted = differences;
  scaled_likelihood best;
  for (const double share : {0.2, 0.35, 0.5, 0.65, 0.8}) {
    const scaled_likelihood found = locate_mixture(differences, outliers, quantile(sorted, share));
    if (found.log_likelihood > best.log_likelihood) best = found;
  }
  return best;
}

}  // namespace gonio::detail
