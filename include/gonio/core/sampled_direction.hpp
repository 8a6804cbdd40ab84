#pragma once
/// A direction drawn by a renderer, with its density and weight. M. Pharr, W. Jakob and G. Humphreys, "Physically Based
/// Rendering", 4th edition 2023, Sec. 9.1.2 and 9.2.

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <numbers>

namespace gonio {

/// A drawn direction towards the light, its weight f cos(theta_i) / pdf, and its density pdf in sr^-1. The weight is
/// zero if nothing could be drawn, or if the direction is below the horizon.
template <std::floating_point Real>
struct basic_sampled_direction {
  Eigen::Matrix<Real, 3, 1> wi = Eigen::Matrix<Real, 3, 1>::UnitZ();
  Eigen::Array<Real, 3, 1> weight = Eigen::Array<Real, 3, 1>::Zero();
  Real pdf = 0;
};

using sampled_direction = basic_sampled_direction<double>;

/// Draws directions towards the light, given the direction towards the viewer, and returns their density.
///
/// Requirements that the compiler cannot check:
/// - `sample(wo, u1, u2)` takes two numbers in [0, 1); `sample(...).pdf` equals `pdf(wi, wo)` for its direction;
/// - the weight times pdf is f cos(theta_i), and pdf is positive wherever f is;
/// - pdf integrates to 1 over the sphere of directions, including those below the horizon, which have weight 0;
/// - if the viewer is not above the horizon, weight and density are zero;
/// - `sample` and `pdf` are thread safe, do not allocate and do not throw.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/model/lobe_sampler.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::model::lobe_sampler sampler{gonio::model::ggx{.alpha = 0.1}};
///   const gonio::sampled_direction drawn = sampler.sample({0.6, 0, 0.8}, 0.3, 0.7);
///   std::printf("density %g sr^-1\n", drawn.pdf);
/// }
/// ```
/// With a model of your own, a white diffuse surface:
/// ```cpp
/// #include <gonio/core/sampled_direction.hpp>
///
/// #include <cstdio>
///
/// struct white_diffuse {
///   gonio::sampled_direction sample(const gonio::direction& wo, double u1, double u2) const noexcept {
///     if (!(wo.z() > 0.0)) return {};
///     const gonio::direction wi = gonio::cosine_weighted_direction(u1, u2);
///     return {wi, gonio::rgb::Ones(), pdf(wi, wo)};
///   }
///   double pdf(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
///     return wi.z() > 0.0 && wo.z() > 0.0 ? wi.z() * std::numbers::inv_pi : 0.0;
///   }
/// };
/// static_assert(gonio::direction_sampler<white_diffuse>);
///
/// int main() { std::printf("density %g sr^-1\n", white_diffuse{}.sample({0, 0, 1}, 0.3, 0.7).pdf); }
/// ```
template <class Sampler>
concept direction_sampler = requires(const Sampler& sampler, const direction& wi, const direction& wo, double u) {
  { sampler.sample(wo, u, u) }
  noexcept->std::convertible_to<sampled_direction>;
  { sampler.pdf(wi, wo) }
  noexcept->std::convertible_to<double>;
};

/// Maps two numbers from 0 to 1 to a direction of density cos(theta) / pi.
template <std::floating_point Real>
[[nodiscard]] Eigen::Matrix<Real, 3, 1> cosine_weighted_direction(Real u1, Real u2) noexcept {
  const Real radius = std::sqrt(u1), azimuth = 2 * std::numbers::pi_v<Real> * u2;
  return {radius * std::cos(azimuth), radius * std::sin(azimuth), std::sqrt(std::max(Real(0), 1 - u1))};
}

/// Returns the density of `cosine_weighted_direction` in sr^-1; zero below the horizon.
template <std::floating_point Real>
[[nodiscard]] Real cosine_weighted_pdf(const Eigen::Matrix<Real, 3, 1>& wi) noexcept {
  return std::max(wi.z(), Real(0)) * std::numbers::inv_pi_v<Real>;
}

}  // namespace gonio
