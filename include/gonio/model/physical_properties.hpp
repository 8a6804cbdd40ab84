#pragma once
/// Checks of the properties of a physical BRDF, for any BRDF: reciprocity, non-negative values, isotropy, and albedo.
/// J. B. Nielsen's thesis (2016), Sec. 2.2.

#include <gonio/core/brdf.hpp>
#include <gonio/core/statistics.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace gonio::model {

/// The largest violation of a property, and the pair of directions where it was found.
struct worst_pair {
  double amount = 0.0;  ///< largest violation; 0 if there is none
  direction_pair at{direction(0.0, 0.0, 1.0), direction(0.0, 0.0, 1.0)};
  double median = 0.0;  ///< median violation of all pairs tested
};

/// Determines the pairs of directions to test: `steps`^3 combinations of viewers and half vectors, denser near
/// highlights.
struct pair_grid {
  int steps = 24;
};

namespace detail {

/// Returns the pair with the largest `amount(wi, wo)`. The viewers are not at the azimuth of an axis, so anisotropic
/// models are tested off their axes.
template <class Amount>
[[nodiscard]] worst_pair worst_of_pairs(const pair_grid& grid, Amount&& amount) {
  constexpr double pi = std::numbers::pi, azimuth = 0.4;
  worst_pair worst;
  std::vector<double> all;
  const auto share = [&](int i) { return (i + 0.5) / grid.steps; };
  for (int i = 0; i < grid.steps; ++i)
    for (int j = 0; j < grid.steps; ++j)
      for (int k = 0; k < grid.steps; ++k) {
        const direction wo = spherical_direction(share(i) * pi / 2.0, azimuth);
        // Half vectors near the normal give directions of light near the mirror direction.
        const direction h = spherical_direction(share(j) * share(j) * pi / 2.0, 2.0 * pi * share(k));
        const direction wi = 2.0 * h.dot(wo) * h - wo;
        if (!(wi.z() > 0.0 && h.dot(wo) > 0.0)) continue;
        all.push_back(amount(wi, wo));
        if (all.back() > worst.amount) worst = {all.back(), {wi, wo}};
      }
  if (!all.empty()) worst.median = median(all);
  return worst;
}

[[nodiscard]] double relative_difference(const rgb& a, const rgb& b);

}  // namespace detail

/// Returns the pair with the largest difference between f(wi, wo) and f(wo, wi), relative to the larger value.
template <brdf Brdf>
[[nodiscard]] worst_pair worst_asymmetry(const Brdf& f, const pair_grid& grid = {}) {
  return detail::worst_of_pairs(grid, [&](const direction& wi, const direction& wo) {
    return detail::relative_difference(f(wi, wo), f(wo, wi));
  });
}

/// Returns the pair at which the reflectance falls farthest below zero, and by how much, in sr^-1.
template <brdf Brdf>
[[nodiscard]] worst_pair worst_negative(const Brdf& f, const pair_grid& grid = {}) {
  return detail::worst_of_pairs(grid,
                                [&](const direction& wi, const direction& wo) { return -rgb(f(wi, wo)).minCoeff(); });
}

/// Returns the pair at which the reflectance changes most if light and viewer rotate about the normal by 120 degrees.
/// The change is relative to the larger value.
template <brdf Brdf>
[[nodiscard]] worst_pair worst_anisotropy(const Brdf& f, const pair_grid& grid = {}) {
  constexpr double angle = 2.0 * std::numbers::pi / 3.0;
  return detail::worst_of_pairs(grid, [&](const direction& wi, const direction& wo) {
    return detail::relative_difference(f(wi, wo), f(turned_about_normal(wi, angle), turned_about_normal(wo, angle)));
  });
}

namespace detail {

/// Calls `add(wi, wo, weight)` for a viewer at the angle `theta` from the normal. The sum of f times weight is
/// `directional_albedo`.
template <class Add>
void for_each_light(double theta, int bins, const Add& add) {
  constexpr double pi = std::numbers::pi;
  const direction wo = spherical_direction(theta, 0.0);
  for (int i = 0; i < bins; ++i) {
    const double s = (i + 0.5) / bins, theta_h = s * s * pi / 2.0;
    const double area = std::sin(theta_h) * (2.0 * s * pi / 2.0 / bins) * (2.0 * pi / bins);
    for (int k = 0; k < bins; ++k) {
      const direction h = spherical_direction(theta_h, (k + 0.5) * 2.0 * pi / bins);
      const double cosine = h.dot(wo);
      const direction wi = 2.0 * cosine * h - wo;
      if (cosine > 0.0 && wi.z() > 0.0) add(wi, wo, 4.0 * cosine * area * wi.z());
    }
  }
}

}  // namespace detail

/// Returns the directional-hemispherical reflectance: the integral over wi of f cos theta_i, for a viewer (by
/// reciprocity, a light) at an angle from the normal, in radians and below pi / 2. Uses the midpoint rule over half
/// vectors in sqrt(theta_h) with `bins`^2 evaluations. The rule resolves highlights wider than about 1e-4 radians. The
/// error is about 2e-3 if the highlight extends to the horizon.
template <brdf Brdf>
[[nodiscard]] rgb directional_albedo(const Brdf& f, double theta, int bins = 400) {
  rgb sum = rgb::Zero();
  detail::for_each_light(
      theta, bins, [&](const direction& wi, const direction& wo, double weight) { sum += rgb(f(wi, wo)) * weight; });
  return sum;
}

/// The fraction of light that is reflected if it arrives at the angle `theta` from the normal, in radians.
struct albedo_at_angle {
  double theta = 0.0;
  rgb value{0.0, 0.0, 0.0};
};

/// Returns `directional_albedo` at every five degrees up to 85, and at 88 degrees.
template <brdf Brdf>
[[nodiscard]] std::vector<albedo_at_angle> albedo_by_angle(const Brdf& f, int bins = 400) {
  std::vector<albedo_at_angle> all;
  for (int degree = 0; degree <= 90; degree += 5) {
    const double theta = radians(degree == 90 ? 88.0 : degree);
    all.push_back({theta, directional_albedo(f, theta, bins)});
  }
  return all;
}

/// The largest albedo of any channel at any angle, and this angle. A value above 1 means that more light leaves than
/// arrives.
struct largest_albedo {
  double value = 0.0, theta = 0.0;
};

[[nodiscard]] largest_albedo largest_of(const std::vector<albedo_at_angle>& albedos);

/// Returns the largest albedo over the angles of `albedo_by_angle`; of an anisotropic BRDF, at four azimuths.
template <brdf Brdf>
[[nodiscard]] largest_albedo find_largest_albedo(const Brdf& f, int bins = 400) {
  if constexpr (requires { f.is_anisotropic(); }) {
    if (f.is_anisotropic()) {
      largest_albedo found;
      for (const double azimuth : {0.0, 45.0, 90.0, 135.0}) {
        const auto turned = [&f, turn = radians(azimuth)](const direction& wi, const direction& wo) noexcept -> rgb {
          return f(turned_about_normal(wi, turn), turned_about_normal(wo, turn));
        };
        const largest_albedo here = largest_of(albedo_by_angle(turned, bins));
        if (here.value > found.value) found = here;
      }
      return found;
    }
  }
  return largest_of(albedo_by_angle(f, bins));
}

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/physical_properties.ipp>
#endif
