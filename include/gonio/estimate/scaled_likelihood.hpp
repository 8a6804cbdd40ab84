#pragma once
/// The likelihood of measurements, given the values of one material times an unknown factor. Expectation-maximisation
/// (outlier_mixture.hpp) finds the factor and the outliers.

#include <gonio/estimate/outlier_mixture.hpp>

#include <limits>
#include <vector>

namespace gonio::detail {

/// The likelihood of measurements at the best factor found for a material.
struct scaled_likelihood {
  double logarithm_of_factor = 0.0;
  double log_likelihood = -std::numeric_limits<double>::infinity();
};

/// Fits an `outlier_mixture` with an unknown centre by expectation-maximisation. `differences` are the logarithms of
/// measurements minus the logarithms of a material's values, `outliers` the density of outliers at each measurement,
/// and `start` the initial logarithm of the factor.
[[nodiscard]] scaled_likelihood locate_mixture(const std::vector<double>& differences,
                                               const std::vector<double>& outliers, double start);

/// Returns the most likely result of five starts, which are quantiles of the differences: a single start may end in a
/// local maximum.
[[nodiscard]] scaled_likelihood best_factor(const std::vector<double>& differences,
                                            const std::vector<double>& outliers);

}  // namespace gonio::detail

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/scaled_likelihood.ipp>
#endif
