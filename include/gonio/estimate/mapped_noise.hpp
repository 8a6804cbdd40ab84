#pragma once
/// Maps relative measurement noise to the domain of a metric.

#include <gonio/basis/basis.hpp>
#include <gonio/core/parallel.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace gonio {

/// The errors of n measurements in the mapped domain.
struct mapped_noise {
  Eigen::VectorXd shift;     ///< means, n values: not zero, because the map is not linear
  Eigen::VectorXd variance;  ///< variances, n values
};

namespace detail {

/// Divides the standard normal distribution into `count` equally likely parts, and returns their medians. Uses
/// bisection.
[[nodiscard]] std::vector<double> normal_quantiles(int count);

}  // namespace detail

/// Maps Gaussian noise whose standard deviation is relative to the value (0.02 is 2 %), for the values of the basis'
/// mean material. Averages over 64 quantiles. The quantiles exclude errors rarer than one in a hundred, which are
/// outliers, not noise. Throws gonio::error for noise that is negative or not finite. O(locations).
template <basis Basis>
[[nodiscard]] mapped_noise map_noise(const Basis& functions, std::span<const location> locations, double noise,
                                     thread_count threads = {}) {
  if (!(noise >= 0.0 && std::isfinite(noise)))
    refuse("the noise must be finite and not negative, not " + std::to_string(noise));
  const Eigen::Index n = std::ssize(locations);
  mapped_noise mapped{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  if (noise == 0.0) return mapped;
  const std::vector<double> quantiles = detail::normal_quantiles(64);
  const auto count = static_cast<double>(quantiles.size());
  for_each_index(
      locations.size(), 1024,
      [&](Eigen::Index i) {
        const auto& metric = functions.metric();
        const double value = reflectance_of(metric, offset_at(functions, locations[i]), locations[i]);
        const double exact = metric.forward(value, locations[i]);
        double sum = 0.0, squares = 0.0;
        for (const double z : quantiles) {
          const double deviation = metric.forward(value * (1.0 + noise * z), locations[i]) - exact;
          sum += deviation;
          squares += deviation * deviation;
        }
        mapped.shift[i] = sum / count;
        mapped.variance[i] = std::max(squares / count - std::pow(sum / count, 2), 0.0);
      },
      threads);
  return mapped;
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/mapped_noise.ipp>
#endif
