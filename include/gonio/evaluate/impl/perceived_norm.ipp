#pragma once
/// Bodies of evaluate/perceived_norm.hpp.

#include <gonio/basis/pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/evaluate/perceived_norm.hpp>
#include <gonio/render/sphere.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace gonio::detail {

GONIO_INLINE double lightness_slope(double luminance) noexcept {
  constexpr double knee = 6.0 / 29.0;
  if (luminance >= 1.0) return 0.0;
  if (luminance <= knee * knee * knee) return 116.0 / (3.0 * knee * knee);
  return 116.0 / (3.0 * std::cbrt(luminance * luminance));
}

}  // namespace gonio::detail
