#pragma once
/// The error variances of an apparatus' readings, in the mapped domain in which a prior is fitted.

#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/design/apparatus.hpp>
#include <gonio/estimate/angular_error.hpp>
#include <gonio/estimate/mapped_noise.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <span>

namespace gonio::design {

/// Returns the error variance of a reading at each location. The effects of noise and dark signal are computed for the
/// prior's mean material; the effect of angular errors is averaged over the prior's materials. O(locations), times k
/// components with an angular error.
template <error_metric Metric>
[[nodiscard]] Eigen::VectorXd reading_variances(const apparatus& with, const pca<Metric>& prior,
                                                std::span<const location> locations, thread_count threads = {}) {
  Eigen::VectorXd variances = map_noise(prior, locations, with.noise, threads).variance;
  const double observations = prior.observations();
  for_each_index(
      variances.size(), 256,
      [&](Eigen::Index i) {
        const location& at = locations[i];
        if (with.dark_signal > 0.0) {
          const double value = reflectance_of(prior.metric(), offset_at(prior, at), at);
          const double off = with.dark_signal / std::max(at.cosine.i * at.cosine.o, 1e-6);
          const double between =
              prior.metric().forward(value + off, at) - prior.metric().forward(std::max(value - off, 0.0), at);
          variances[i] += between * between / 4.0;
        }
        if (with.angular_error > 0.0)
          variances[i] += angular_error_penalty(prior, to_directions(at.angles), with.angular_error) / observations;
      },
      threads);
  return variances;
}

}  // namespace gonio::design
