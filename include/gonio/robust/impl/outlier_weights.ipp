#pragma once
/// Bodies of robust/outlier_weights.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/robust/outlier_weights.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace gonio {

GONIO_INLINE channel_values relative_deviation_weights::weigh(const channel_values& measured,
                                                              const channel_values& estimated) const {
  const channel_values estimate = estimated.max(1e-6f);
  const channel_values weights = (-static_cast<float>(gamma) * (measured - estimate).abs() / estimate).exp();
  // For large deviations Eigen's vectorised exponential ends at the smallest normal number, not at zero.
  return (weights - std::numeric_limits<float>::min()).max(0.0f);
}

}  // namespace gonio
