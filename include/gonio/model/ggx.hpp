#pragma once
/// The GGX microfacet model, isotropic and anisotropic, reflection only. Walter, Marschner, Li and Torrance,
/// "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007 (doi:10.2312/EGWR/EGSR07/195-206): Eq. 20 (the
/// BRDF), 23 (masking of both directions), 33 (distribution), 34 (Smith's masking of one direction). The Fresnel factor
/// is C. Schlick's, "An Inexpensive BRDF Model for Physically-based Rendering", EG 1994
/// (doi:10.1111/1467-8659.1330233).

#include <gonio/core/assertion.hpp>
#include <gonio/core/brdf.hpp>
#include <gonio/core/fresnel.hpp>
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

/// The masking G1 of Eq. 34, divided by twice the cosine.
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
/// The value is finite for all directions above the horizon: the cosines of the denominator are cancelled against the
/// cosines of G, and the sine of theta_h is computed from components, not from 1 - cos^2.
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

/// The GGX model as the shape of a lobe, for fits. All channels share its f0.
template <class Real>
struct ggx_shape {
  static constexpr std::string_view name = "ggx";
  static constexpr std::array parameters{shape_parameter{"alpha", "slope", 0.002, 1.0, 0.2, true},
                                         shape_parameter{"f0", "", 0.0, 1.0, 0.1}};
  static auto members(auto& self) { return std::tie(self.alpha, self.f0); }

  Real alpha = Real(0.2);  ///< roughness
  Real f0 = Real(0.1);     ///< reflectance of a facet at normal incidence; the colour scales the lobe, too

  [[nodiscard]] Real operator()(const lobe_geometry& at) const {
    const Real masking = detail::ggx_masking_over_twice_cosine(at.cosine_i, alpha) *
                         detail::ggx_masking_over_twice_cosine(at.cosine_o, alpha);
    return fresnel_schlick(at.cosine_d, f0) * detail::ggx_distribution(at.h, alpha) * masking;
  }
};
static_assert(lobe_shape<ggx_shape>);

using ggx_lobe = lobe<ggx_shape>;

static_assert(brdf<ggx_lobe>);

/// GGX that is rougher along one axis than along the other: slopes are scaled by alpha_x and alpha_y (E. Heitz,
/// "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014). A table over half and
/// difference angles cannot hold it.
template <class Real>
struct anisotropic_ggx_shape {
  static constexpr std::string_view name = "ggx-anisotropic";
  static constexpr bool is_anisotropic = true;
  static constexpr std::array parameters{shape_parameter{"alpha_x", "slope", 0.002, 1.0, 0.1, true},
                                         shape_parameter{"alpha_y", "slope", 0.002, 1.0, 0.3, true},
                                         shape_parameter{"f0", "", 0.0, 1.0, 0.1}, axes_rotation};
  static auto members(auto& self) { return std::tie(self.alpha_x, self.alpha_y, self.f0, self.rotation); }

  Real alpha_x = Real(0.1);   ///< roughness along the rotated x axis
  Real alpha_y = Real(0.3);   ///< roughness along the rotated y axis
  Real f0 = Real(0.1);        ///< reflectance of a facet at normal incidence; the lobe's colour also scales the whole
  Real rotation = Real(0.0);  ///< azimuth of the rotated x axis

  [[nodiscard]] Real operator()(const lobe_geometry& at) const {
    const Real masking =
        masking_over_twice_cosine(at.cosine_i, at.x_i, at.y_i) * masking_over_twice_cosine(at.cosine_o, at.x_o, at.y_o);
    return fresnel_schlick(at.cosine_d, f0) * distribution(at.h) * masking;
  }

  /// D(h) in sr^-1. Its integral with the cosine is 1.
  [[nodiscard]] Real distribution(const direction& h) const {
    const Real spread = scaled_square(h.x(), h.y(), rotation, Real(1.0 / alpha_x), Real(1.0 / alpha_y)) + h.z() * h.z();
    return std::numbers::inv_pi / (alpha_x * alpha_y * spread * spread);
  }

  /// Smith's G1 over twice the cosine, of a direction with this cosine and tangential part.
  [[nodiscard]] Real masking_over_twice_cosine(double cosine, double x, double y) const {
    using std::sqrt;
    return 1.0 / (cosine + sqrt(Real(scaled_square(x, y, rotation, alpha_x, alpha_y) + cosine * cosine)));
  }
};
static_assert(lobe_shape<anisotropic_ggx_shape>);

using anisotropic_ggx = lobe<anisotropic_ggx_shape>;

static_assert(brdf<anisotropic_ggx>);

}  // namespace gonio::model
