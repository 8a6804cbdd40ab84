#pragma once
/// Bodies of estimate/outlier_weights.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/outlier_weights.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace gonio {

GONIO_INLINE channel_values relative_deviation_weights::weigh(const channel_values& measured,
                                                              const channel_values& estimated) const {
  const channel_values estimate = estimated.max(1e-6f);
  const channel_values weights = (-static_cast<float>(gamma) * (measured - estimate).abs() / estimate).exp();
  // Far out Eigen's vectorised exponential ends at the smallest normal number, not at zero.
  return (weights - std::numeric_limits<float>::min()).max(0.0f);
}

GONIO_INLINE channel_values tukey_weights::weigh(const channel_values& measured,
                                                 const channel_values& estimated) const {
  const channel_values deviation = ((measured.max(0.0f) + offset).log() - (estimated + offset).log()).abs();
  channel_values weights(3, measured.cols());
  for (Eigen::Index c = 0; c < 3; ++c) {
    // Rounding is no deviation.
    const float limit = static_cast<float>(cutoff) * std::max(1.4826f * detail::upper_median(deviation.row(c)), 1e-6f);
    weights.row(c) = (1.0f - (deviation.row(c) / limit).square()).max(0.0f).square();
  }
  return weights;
}

}  // namespace gonio
