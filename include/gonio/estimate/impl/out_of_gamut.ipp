#pragma once
/// Bodies of estimate/out_of_gamut.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/estimate/out_of_gamut.hpp>

#include <algorithm>
#include <optional>

namespace gonio {

GONIO_INLINE std::optional<located_samples> out_of_gamut_as_xyz(const located_samples& samples) {
  constexpr double usual_share = 0.1;  // fraction of samples that noise alone may make negative
  if (samples.values.cols() != 3 || samples.weighs_channels_apart()) return {};
  const auto colour_of = [&](Eigen::Index i) {
    return rgb(samples.values(i, 0), samples.values(i, 1), samples.values(i, 2));
  };
  Eigen::Index negative = 0;
  for (Eigen::Index i = 0; i < samples.size(); ++i)
    if (std::min({samples.values(i, 0), samples.values(i, 1), samples.values(i, 2)}) < 0.0) ++negative;
  if (static_cast<double>(negative) <= usual_share * static_cast<double>(samples.size())) return {};
  const rgb white = to_xyz(rgb::Ones());
  located_samples converted = samples;
  for (Eigen::Index i = 0; i < samples.size(); ++i) {
    const rgb xyz = to_xyz(colour_of(i)) / white;
    for (Eigen::Index c = 0; c < 3; ++c) converted.values(i, c) = xyz[c];
  }
  return converted;
}

}  // namespace gonio
