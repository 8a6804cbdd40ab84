#pragma once
/// Measurements in the domain of a basis.

#include <gonio/basis/basis.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/estimate/located_samples.hpp>

#include <utility>

namespace gonio {

/// Maps samples by the metric of a basis and subtracts the basis' offset at each location. O(samples).
template <colour_basis Basis>
[[nodiscard]] located_samples map_samples(const Basis& functions, located_samples samples, thread_count threads = {}) {
  if constexpr (!basis<Basis>) samples = in_colours(std::move(samples));
  for_each_index(
      samples.locations.size(), 1024,
      [&](Eigen::Index i) {
        const location& at = samples.locations[i];
        double offset = 0.0;
        for (Eigen::Index c = 0; c < samples.values.cols(); ++c) {
          if (c == 0 || !basis<Basis>) offset = offset_at(channel_of(functions, c), at);
          samples.values(i, c) = functions.metric().forward(samples.values(i, c), at) - offset;
        }
      },
      threads);
  return samples;
}

}  // namespace gonio
