#pragma once
/// Bodies of model/physical_properties.hpp.

#include <gonio/core/brdf.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/model/physical_properties.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace gonio::model::detail {

GONIO_INLINE double relative_difference(const rgb& a, const rgb& b) {
  const double size = std::max(a.abs().maxCoeff(), b.abs().maxCoeff());
  return size > 0.0 ? (a - b).abs().maxCoeff() / size : 0.0;
}

}  // namespace gonio::model::detail

namespace gonio::model {

GONIO_INLINE largest_albedo largest_of(const std::vector<albedo_at_angle>& albedos) {
  largest_albedo found;
  for (const auto& [theta, value] : albedos)
    if (value.maxCoeff() > found.value) found = {value.maxCoeff(), theta};
  return found;
}

}  // namespace gonio::model
