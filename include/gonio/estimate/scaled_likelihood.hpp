#pragma once
/// How likely measurements are, given the values of one material that is brightened or darkened: by what factor, and
/// which of the measurements are outliers, is found by expectation-maximisation (outlier_mixture.hpp).

#include <gonio/estimate/outlier_mixture.hpp>

#include <limits>
#include <vector>

namespace gonio::detail {

/// How likely measurements are, given a material's values, at the best factor found.
struct scaled_likelihood {
  double logarithm_of_factor = 0.0;
  double log_likelihood = -std::numeric_limits<double>::infinity();
};

/// Expectation-maximisation of an `outlier_mixture` whose centre is unknown: `differences` are the logarithms of
/// measurements less those of a material.
[[nodiscard]] scaled_likelihood locate_mixture(const std::vector<double>& differences,
                                               const std::vector<double>& outliers, double start);

/// The best of several starts, for the mode of the differences may be anywhere.
[[nodiscard]] scaled_likelihood best_factor(const std::vector<double>& differences,
                                            const std::vector<double>& outliers);

}  // namespace gonio::detail

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/scaled_likelihood.ipp>
#endif
