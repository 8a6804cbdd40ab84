#pragma once
/// Tukey's biweight, for comparison with the iteration's weights.

#include <gonio/core/statistics.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/robust/outlier_weights.hpp>

#include <algorithm>

namespace gonio {

/// Tukey's biweight of the logarithmic deviation, (1 - (u/c)^2)^2 within c and 0 outside: a redescending M-estimator
/// with 95 % efficiency for Gaussian errors (Huber, Robust Statistics, 1981). u is the deviation divided by 1.4826
/// times the median deviation, for each channel separately. Breaks down if half of the measurements are outliers.
struct tukey_weights {
  double cutoff = 4.685;
  /// Added to measurement and estimate before the logarithm, in sr^-1.
  float offset = 1e-3f;

  [[nodiscard]] channel_values weigh(const channel_values& measured, const channel_values& estimated) const;
};

static_assert(outlier_weighting<tukey_weights>);

inline channel_values tukey_weights::weigh(const channel_values& measured, const channel_values& estimated) const {
  const channel_values deviation = ((measured.max(0.0f) + offset).log() - (estimated + offset).log()).abs();
  channel_values weights(3, measured.cols());
  for (Eigen::Index c = 0; c < 3; ++c) {
    // Ignores deviations due to rounding.
    std::vector<float> sorted;
    for (const float value : deviation.row(c)) sorted.push_back(value);
    const float limit = static_cast<float>(cutoff) * std::max(1.4826f * upper_median(sorted), 1e-6f);
    weights.row(c) = (1.0f - (deviation.row(c) / limit).square()).max(0.0f).square();
  }
  return weights;
}

}  // namespace gonio
