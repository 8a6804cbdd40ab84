#pragma once
/// Measurements that were taken together, and that keep which of their directions is the light's.

#include <gonio/core/direction.hpp>
#include <gonio/table/sample_set.hpp>

#include <vector>

namespace gonio {

/// A measurement of which light and viewer are known apart. `sample`, by its half and difference angles, forgets it:
/// reflectance is the same either way, but what moves the light does not move the viewer.
struct pair_sample {
  direction_pair directions;
  rgb value = rgb::Zero();  ///< sr^-1
  double weight = 1.0;      ///< how much it counts
};

/// Those of one image: with one light and one camera, so that what is wrong with where these are is the same for all.
using image_samples = std::vector<pair_sample>;

/// As samples for any estimator.
[[nodiscard]] sample_set as_sample_set(const image_samples& picture);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/image_samples.ipp>
#endif
