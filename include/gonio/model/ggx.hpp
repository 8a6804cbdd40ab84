#pragma once
/// The isotropic GGX microfacet model, reflection only.
/// Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007
/// (doi:10.2312/EGWR/EGSR07/195-206):
/// Eq. 20 (the BRDF), 23 (masking of both directions), 33 (distribution), 34 (Smith's masking of one).
/// The Fresnel factor is C. Schlick's, "An Inexpensive BRDF Model for Physically-based Rendering", EG 1994
/// (doi:10.1111/1467-8659.1330233).

#include <gonio/core/assertion.hpp>
#include <gonio/core/brdf.hpp>
#include <gonio/model/fresnel.hpp>
#include <gonio/model/lobe.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace gonio::model {

namespace detail {

/// Eq. 33.
template <class Real>
[[nodiscard]] Real ggx_distribution(const direction& h, const Real& alpha) {
  const double squared_sine = h.x() * h.x() + h.y() * h.y();
  const Real squared_alpha = alpha * alpha;
  const Real spread = squared_sine + squared_alpha * (h.z() * h.z());
  return squared_alpha * std::numbers::inv_pi / (spread * spread);
}

/// Eq. 34.
template <class Real>
[[nodiscard]] Real ggx_masking_over_twice_cosine(double cosine, const Real& alpha) {
  using std::sqrt;
  const double squared = cosine * cosine;
  return 1.0 / (cosine + sqrt(Real(squared + alpha * alpha * (1.0 - squared))));
}

}  // namespace detail

/// F D G / (4 cos_i cos_o). Masking is Smith's height-uncorrelated form, as in the paper: G = G1(wi) G1(wo).
/// ```cpp
/// const gonio::model::ggx varnish{.alpha = 0.15, .f0 = gonio::rgb::Constant(0.04)};
/// ```
/// The value is finite for all directions above the horizon. With h = wi + wo, the cosines of the denominator cancel
/// against those of G, and sines are computed from components, not from 1 - cos^2.
struct ggx {
  /// Roughness: the width of the microfacet distribution, about the tangent of its typical slope. In (0, 1].
  double alpha = 0.2;
  /// Reflectance of a microfacet at normal incidence, in [0, 1].
  rgb f0 = rgb::Constant(0.04);

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
    const lobe_geometry at(wi, wo);
    const double masking_over_cosines = detail::ggx_masking_over_twice_cosine(at.cosine_i, alpha) *
                                        detail::ggx_masking_over_twice_cosine(at.cosine_o, alpha);
    return fresnel(at.cosine_d) * (distribution(at.h) * masking_over_cosines);
  }

  /// D(h) of Eq. 33, in sr^-1: the area of microfacets with normal h. Its integral with the cosine is 1.
  [[nodiscard]] double distribution(const direction& h) const noexcept {
    GONIO_ASSERT(alpha > 0.0);
    return detail::ggx_distribution(h, alpha);
  }

  /// G1 of Eq. 34: the fraction of microfacets visible at this cosine, independent of their normal.
  [[nodiscard]] double masking(double cosine) const noexcept {
    return 2.0 * cosine * detail::ggx_masking_over_twice_cosine(cosine, alpha);
  }

  /// Schlick's approximation of the Fresnel reflectance. `cosine` is between wi and h.
  [[nodiscard]] rgb fresnel(double cosine) const noexcept { return fresnel_schlick(cosine, f0); }
};

static_assert(brdf<ggx>);

/// The same model as the shape of a lobe, for fits. All colours share its f0.
template <class Real>
struct ggx_shape {
  static constexpr std::string_view name = "ggx";
  static constexpr std::array parameters{shape_parameter{"alpha", "slope", 0.002, 1.0, 0.2, true},
                                         shape_parameter{"f0", "", 0.0, 1.0, 0.1}};
  static auto members(auto& self) { return std::tie(self.alpha, self.f0); }

  Real alpha = Real(0.2);  ///< roughness
  Real f0 = Real(0.1);     ///< reflectance of a facet at normal incidence; the lobe's colour also scales the whole

  [[nodiscard]] Real operator()(const lobe_geometry& at) const {
    const Real masking = detail::ggx_masking_over_twice_cosine(at.cosine_i, alpha) *
                         detail::ggx_masking_over_twice_cosine(at.cosine_o, alpha);
    return fresnel_schlick(at.cosine_d, f0) * detail::ggx_distribution(at.h, alpha) * masking;
  }
};
static_assert(lobe_shape<ggx_shape>);

using ggx_lobe = lobe<ggx_shape>;

static_assert(brdf<ggx_lobe>);

}  // namespace gonio::model
