#pragma once
/// From exposures of a material and of a white reference to the BRDF: the relative method (Nielsen's thesis 2016, note
/// on relative BRDF measurement, Sec. 2, 4 and 5).

#include <gonio/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace gonio::capture {

/// The solid angle in sr of a lens of effective diameter D = f / F from a distance r, which is what a pixel receives
/// (Eq. 4 and 5). All lengths in the same unit. Throws gonio::error unless all are positive and finite.
[[nodiscard]] double pixel_solid_angle(double focal_length, double f_number, double distance);

/// A number and its standard deviation.
struct uncertain {
  double value = 0.0, deviation = 0.0;

  [[nodiscard]] double relative_deviation() const noexcept { return deviation / std::abs(value); }
};

/// Where a sample lies in the light of a lamp: cosine of the angle of incidence, and the distance to the lamp.
struct illumination {
  double cosine = 1.0, distance = 1.0;
};

/// What a lamp does, from the exposure of a white reference: k_ill of Eq. 21, once for each lamp and camera pose.
///
/// The note's Eq. 18 reads f = X_mat / (X_ref pi), which is f = dL / dE for a reference that reflects all light evenly,
/// L_ref = E / pi. A reference of reflectance rho has L_ref = rho E / pi, hence rho here. In Eq. 19 as printed the
/// cosines are exchanged in one of its two forms; E is proportional to cos(theta_i) / d^2, from which Eq. 20 follows.
class reference_light {
 public:
  /// `exposure` of the reference per second and its deviation. Throws gonio::error unless it, the reflectance, the
  /// cosine and the distance are positive and finite, and reflectance and cosine at most 1.
  reference_light(const uncertain& exposure, double reflectance, const illumination& at = {});

  /// f of a material in sr^-1 from its exposure at the same time and camera pose (Eq. 22), with the deviation that both
  /// exposures cause. Throws as the constructor does for where the material lies.
  [[nodiscard]] uncertain brdf(const uncertain& exposure, const illumination& at = {}) const;

 private:
  static void require_usable(const illumination& at);

  double per_exposure_ = 0.0, relative_variance_ = 0.0;
};

/// The share of a lamp's light that a material sends into a solid angle around a direction of cosine `cosine_out`: the
/// reflectance of Eq. 17, rho = f Omega cos(theta_o). With f of a perfect reference it is Eq. 13.
[[nodiscard]] inline double reflectance_into(double brdf, double solid_angle, double cosine_out) noexcept {
  return brdf * solid_angle * cosine_out;
}

/// How much a value counts whose relative deviation is known: as variances of the logarithm add up, s^2 / (s^2 + d^2),
/// where s is by how much a basis is off a material that it does not know. Noise of a few percent says little against a
/// sample; and that a channel is about black is known even where its value is all noise: weighed by 1 / d^2 it would be
/// left to the basis, which expects a grey one.
[[nodiscard]] inline double weight_of(double relative_deviation, double unknown = 1.0) noexcept {
  const double ratio = relative_deviation / unknown;
  return std::isfinite(relative_deviation) ? 1.0 / (1.0 + ratio * ratio) : 0.0;
}

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/relative_reflectance.ipp>
#endif
