#pragma once
/// Scattered measurements of a BRDF: what a laboratory hands in, and every estimator takes.

#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/rgb.hpp>

#include <cmath>
#include <concepts>
#include <numbers>
#include <ranges>
#include <string>
#include <vector>

namespace gonio {

/// One measurement: where, what (sr^-1, without the cosine; may be negative), and how much it counts.
struct sample {
  half_difference angles;
  rgb value = rgb::Zero();
  double weight = 1.0;
};

/// Any range of measurements. A laboratory with a struct of its own hands it over in place:
/// `estimator.fit(readings | std::views::transform(to_sample))`.
template <class Range>
concept sample_range =
    std::ranges::forward_range<Range> && std::convertible_to<std::ranges::range_reference_t<Range>, sample>;

using sample_set = std::vector<sample>;

/// Refuses what no estimator can use: throws gonio::error naming the first sample that is not finite, has
/// a negative weight, or has a direction at or below the horizon, or saying that there is none at all.
template <sample_range Samples>
void require_usable(const Samples& samples) {
  std::size_t number = 0;
  for (const sample& s : samples) {
    ++number;
    const auto refuse = [&](const std::string& what) { throw error("sample " + std::to_string(number) + ": " + what); };
    const auto& [theta_h, theta_d, phi_d] = s.angles;
    if (!std::isfinite(theta_h) || !std::isfinite(theta_d) || !std::isfinite(phi_d)) refuse("an angle is not finite");
    if (!s.value.isFinite().all()) refuse("a reflectance is not finite");
    if (!std::isfinite(s.weight) || s.weight < 0.0) refuse("the weight must be finite and not negative");
    const cosine_pair cosine = cosines(s.angles);
    constexpr double right_angle = std::numbers::pi / 2.0;
    const bool in_range = theta_h >= 0.0 && theta_h < right_angle && theta_d >= 0.0 && theta_d < right_angle;
    if (!in_range || !(cosine.i > 0.0 && cosine.o > 0.0))
      refuse("a direction is at or below the horizon (theta_h " + std::to_string(degrees(theta_h)) + ", theta_d " +
             std::to_string(degrees(theta_d)) + ", phi_d " + std::to_string(degrees(phi_d)) + " degrees)");
  }
  if (number == 0) throw error("there are no samples: at least one is needed");
}

}  // namespace gonio
