#pragma once
/// Bodies of estimate/scaled_likelihood.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/scaled_likelihood.hpp>

#include <algorithm>
#include <cmath>

namespace gonio::detail {

GONIO_INLINE scaled_likelihood locate_mixture(const Eigen::ArrayXd& differences, const Eigen::ArrayXd& outliers,
                                              double start) {
  constexpr int steps = 8;
  constexpr double smallest_scale = 0.02;
  constexpr double nu = outlier_mixture::degrees_of_freedom;
  const auto n = static_cast<double>(differences.size());
  outlier_mixture mixture{0.5, 0.3};
  scaled_likelihood found{start};
  for (int step = 0; step < steps; ++step) {
    const Eigen::ArrayXd residuals = differences - found.logarithm_of_factor;
    const Eigen::ArrayXd shares = mixture.probability(residuals, outliers);
    const Eigen::ArrayXd on_tail = shares * mixture.tail_weight(residuals);
    const double good = shares.sum(), weight = on_tail.sum();
    const double squares = (nu + 1.0) / nu * (on_tail * residuals.square()).sum();
    found.logarithm_of_factor = weight > 0.0 ? (on_tail * differences).sum() / weight : start;
    if (step + 1 == steps) found.log_likelihood = mixture.density(residuals, outliers).log().sum();
    mixture = {std::clamp(good / n, 0.05, 0.99), std::max(std::sqrt(squares / std::max(good, 1e-9)), smallest_scale)};
  }
  return found;
}

GONIO_INLINE scaled_likelihood best_factor(const Eigen::ArrayXd& differences, const Eigen::ArrayXd& outliers) {
  Eigen::ArrayXd sorted = differences;
  std::sort(sorted.begin(), sorted.end());
  scaled_likelihood best;
  for (const double share : {0.2, 0.35, 0.5, 0.65, 0.8}) {
    const auto position = static_cast<Eigen::Index>(share * static_cast<double>(sorted.size() - 1));
    const scaled_likelihood found = locate_mixture(differences, outliers, sorted[position]);
    if (found.log_likelihood > best.log_likelihood) best = found;
  }
  return best;
}

}  // namespace gonio::detail
