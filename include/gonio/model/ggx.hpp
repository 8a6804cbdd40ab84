#pragma once
/// The isotropic GGX microfacet model, reflection only.
/// Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007:
/// Eq. 20 (the BRDF), 23 (masking of both directions), 33 (distribution), 34 (Smith's masking of one).
/// The Fresnel factor is C. Schlick's, "An Inexpensive BRDF Model for Physically-based Rendering", EG 1994.

#include <gonio/core/assertion.hpp>
#include <gonio/core/brdf.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gonio {

/// F D G / (4 cos_i cos_o). Masking is Smith's, height-uncorrelated as in the paper: G = G1(wi) G1(wo).
/// ```cpp
/// const gonio::ggx varnish{.alpha = 0.15, .f0 = gonio::rgb::Constant(0.04)};
/// ```
/// With h = wi + wo there is no direction above the horizon at which it is not finite: the cosines of the
/// denominator cancel against those of G, and sines come from components, not from 1 - cos^2.
struct ggx {
  /// Roughness: the width of the microfacet distribution, about the tangent of its typical slope. In (0, 1].
  double alpha = 0.2;
  /// Reflectance of a microfacet at normal incidence, in [0, 1].
  rgb f0 = rgb::Constant(0.04);

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
    const direction sum = wi + wo;
    const double length = sum.norm();
    // Directions that are opposite up to rounding leave no half vector; the normal is the limit within the plane.
    const direction h = length > 0.0 ? direction(sum / length) : direction(0.0, 0.0, 1.0);
    const double masking_over_cosines = masking_over_twice_cosine(wi.z()) * masking_over_twice_cosine(wo.z());
    return fresnel(0.5 * length) * (distribution(h) * masking_over_cosines);
  }

  /// D(h) of Eq. 33, in sr^-1: area of microfacets with normal h. Its integral with the cosine is 1.
  [[nodiscard]] double distribution(const direction& h) const noexcept {
    GONIO_ASSERT(alpha > 0.0);
    const double squared_sine = h.x() * h.x() + h.y() * h.y();
    const double squared_alpha = alpha * alpha;
    const double spread = squared_sine + squared_alpha * h.z() * h.z();
    return squared_alpha * std::numbers::inv_pi / (spread * spread);
  }

  /// G1 of Eq. 34: the fraction of microfacets that is visible at this cosine, whichever their normal.
  [[nodiscard]] double masking(double cosine) const noexcept {
    return 2.0 * cosine * masking_over_twice_cosine(cosine);
  }

  /// Schlick's approximation of the Fresnel reflectance; `cosine` is that of wi with h.
  [[nodiscard]] rgb fresnel(double cosine) const noexcept {
    const double rest = std::max(1.0 - cosine, 0.0);  // a cosine may round to more than 1
    return f0 + (1.0 - f0) * (rest * rest * rest * rest * rest);
  }

 private:
  [[nodiscard]] double masking_over_twice_cosine(double cosine) const noexcept {
    const double squared = cosine * cosine;
    return 1.0 / (cosine + std::sqrt(squared + alpha * alpha * (1.0 - squared)));
  }
};

static_assert(brdf<ggx>);

}  // namespace gonio
