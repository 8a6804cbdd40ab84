#pragma once
/// Bodies of interpolate/scattered_options.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/interpolate/scattered_options.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace gonio {

GONIO_INLINE std::array<double, 4> pair_embedding::operator()(const half_difference& angles) const noexcept {
  constexpr double right_angle = std::numbers::pi / 2.0;
  const double around = phi_d_scale * std::sin(angles.theta_h) * std::sin(angles.theta_d);
  return {std::sqrt(std::max(angles.theta_h, 0.0) / right_angle), theta_d_scale * angles.theta_d / right_angle,
          around * std::cos(2.0 * angles.phi_d), around * std::sin(2.0 * angles.phi_d)};
}

GONIO_INLINE void require_usable(const scattered_options& options) {
  if (options.neighbours < 1 || options.neighbours > scattered_options::most_neighbours)
    refuse({"scattered samples are interpolated between 1 and ", scattered_options::most_neighbours,
            " neighbours, not ", options.neighbours});
  const auto require_positive = [](const char* what, double value) {
    if (!(value > 0.0 && value <= 100.0))
      refuse({"the ", what, " of scattered samples must be above 0 and at most 100, not ", value});
  };
  require_positive("exponent", options.exponent);
  require_positive("theta_d scale", options.embedding.theta_d_scale);
  require_positive("phi_d scale", options.embedding.phi_d_scale);
}

}  // namespace gonio
