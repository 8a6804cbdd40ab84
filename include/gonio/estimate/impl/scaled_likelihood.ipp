#pragma once
/// Bodies of estimate/scaled_likelihood.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/scaled_likelihood.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gonio::detail {

GONIO_INLINE scaled_likelihood locate_mixture(const std::vector<double>& differences,
                                              const std::vector<double>& outliers, double start) {
  constexpr int steps = 8;
  constexpr double smallest_scale = 0.02;
  constexpr double nu = outlier_mixture::degrees_of_freedom;
  const Eigen::Index count = std::ssize(differences);
  Eigen::VectorXd shares(count), on_tail(count), squared(count), located(count);
  outlier_mixture mixture{0.5, 0.3};
  scaled_likelihood found{start};
  for (int step = 0; step < steps; ++step) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const double residual = differences[i] - found.logarithm_of_factor;
      shares[i] = mixture.probability(residual, outliers[i]);
      on_tail[i] = shares[i] * mixture.tail_weight(residual);
      squared[i] = on_tail[i] * (residual * residual);
      located[i] = on_tail[i] * differences[i];
    }
    const double good = shares.sum(), weight = on_tail.sum(), squares = (nu + 1.0) / nu * squared.sum();
    if (step + 1 == steps) {
      for (Eigen::Index i = 0; i < count; ++i)
        shares[i] = mixture.density(differences[i] - found.logarithm_of_factor, outliers[i]);
      take_logarithms(shares.data(), count);
      found.log_likelihood = shares.sum();
    }
    found.logarithm_of_factor = weight > 0.0 ? located.sum() / weight : start;
    mixture = {std::clamp(good / static_cast<double>(count), 0.05, 0.99),
               std::max(std::sqrt(squares / std::max(good, 1e-9)), smallest_scale)};
  }
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
