#pragma once
/// The microfacet model of K. E. Torrance and E. M. Sparrow 1967 (doi:10.1364/JOSA.57.001105), in the form of R. L.
/// Cook and K. E. Torrance, "A Reflectance Model for Computer Graphics", ACM TOG 1982 (doi:10.1145/357290.357293): J.
/// B. Nielsen's thesis, Eq. 2.19-2.22.

#include <gonio/core/fresnel.hpp>
#include <gonio/model/lobe.hpp>

#include <numbers>

namespace gonio::model {

/// The shape D F G / (4 cos theta_i cos theta_o): Beckmann's distribution D, Schlick's Fresnel factor F, and the
/// masking G of V-cavities. The thesis prints Eq. 2.21 with cos theta_i, which is not reciprocal. Here, as in the
/// source of that equation, the cosine is between light and half vector.
template <class Real>
struct torrance_sparrow_shape {
  static constexpr std::string_view name = "torrance-sparrow";
  static constexpr std::array parameters{shape_parameter{"slope", "slope", 0.005, 2.0, 0.2, true},
                                         shape_parameter{"f0", "", 0.0, 1.0, 0.1}};
  static auto members(auto& self) { return std::tie(self.slope, self.f0); }

  Real slope = Real(0.2);  ///< m, the root mean square slope of the facets
  Real f0 = Real(0.1);     ///< reflectance of a facet at normal incidence; the colour scales the lobe, too

  [[nodiscard]] Real operator()(const lobe_geometry& at) const {
    const double cosine_h = at.h.z();
    const double largest_cosine = std::max(at.cosine_i, at.cosine_o);
    // Compute G / (4 cos theta_i cos theta_o). The cosines cancel where facets mask each other.
    const double masking = std::min(
        {0.25 / (at.cosine_i * at.cosine_o), 0.5 * cosine_h / at.cosine_d / largest_cosine, largest_reflectance});
    return distribution(at.squared_tangent_h()) * fresnel_schlick(at.cosine_d, f0) * masking;
  }

  /// The distribution D of Eq. 2.20, in sr^-1, given tan^2 of the angle between facet and normal.
  [[nodiscard]] Real distribution(double squared_tangent) const {
    using std::exp;
    const Real squared_slope = slope * slope;
    const Real exponent = squared_tangent / squared_slope;
    if (!(exponent < 700.0)) return Real(0.0);
    const double squared_secant = 1.0 + squared_tangent;
    return exp(Real(-exponent)) * (squared_secant * squared_secant * std::numbers::inv_pi) / squared_slope;
  }
};
static_assert(lobe_shape<torrance_sparrow_shape>);

using torrance_sparrow = lobe<torrance_sparrow_shape>;

static_assert(brdf<torrance_sparrow>);

}  // namespace gonio::model
