#pragma once
/// Bodies of table/sample_set.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/table/sample_set.hpp>

#include <cmath>
#include <limits>
#include <numbers>

namespace gonio::detail {

GONIO_INLINE void require_usable_sample(const sample& s, Eigen::Index number) {
  const auto refuse = [&](const char* what) { gonio::refuse({"sample ", number, ": ", what}); };
  const auto& [theta_h, theta_d, phi_d] = s.angles();
  if (!std::isfinite(theta_h) || !std::isfinite(theta_d) || !std::isfinite(phi_d)) refuse("an angle is not finite");
  for (Eigen::Index channel = 0; channel < 3; ++channel)
    if (!std::isfinite(s.value[channel])) refuse("a reflectance is not finite");
  for (Eigen::Index channel = 0; channel < 3; ++channel)
    if (std::abs(s.value[channel]) > double{std::numeric_limits<float>::max()})
      refuse("a reflectance is beyond the range of float");
  for (Eigen::Index channel = 0; channel < 3; ++channel)
    if (!std::isfinite(s.weight[channel]) || s.weight[channel] < 0.0)
      refuse("the weight must be finite and not negative");
  const cosine_pair cosine = cosines(s.angles());
  constexpr double right_angle = std::numbers::pi / 2.0;
  const bool in_range = theta_h >= 0.0 && theta_h < right_angle && theta_d >= 0.0 && theta_d < right_angle;
  if (!in_range || !(cosine.i > 0.0 && cosine.o > 0.0))
    gonio::refuse({"sample ", number, ": a direction is at or below the horizon (theta_h ", degrees(theta_h),
                   ", theta_d ", degrees(theta_d), ", phi_d ", degrees(phi_d), " degrees)"});
}

GONIO_INLINE void refuse_no_samples() { gonio::refuse("there are no samples: at least one is needed"); }

}  // namespace gonio::detail
