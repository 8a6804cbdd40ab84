#include "tool/options/scattered_samples.hpp"

#include <gonio/interpolate/scattered_brdf.hpp>

namespace cli {

interpolated_samples interpolate(const gonio::sample_set& samples, const gonio::scattered_options& options) {
  return {gonio::scattered_interpolation{options}.fit(samples)};
}

}  // namespace cli
