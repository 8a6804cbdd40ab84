#pragma once
/// The BRDF from exposures of a material and of a white reference (the relative method), or of the material and of the
/// lamp itself (the absolute method): Nielsen's thesis 2016, note on relative BRDF measurement, Sec. 1, 2, 4 and 5.

#include <gonio/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace gonio::capture {

/// Returns the half angle in radians of the cone from which a pixel receives light through a lens of diameter
/// focal_length / f_number (Eq. 1 and 5). All lengths have the same unit. Throws gonio::error unless all are positive
/// and finite.
[[nodiscard]] double pixel_half_angle(double focal_length, double f_number, double distance);

/// Returns the solid angle in sr from which a pixel receives light: the solid angle of this cone (Eq. 4 and 5). Throws
/// gonio::error as `pixel_half_angle` does.
[[nodiscard]] double pixel_solid_angle(double focal_length, double f_number, double distance);

/// A number and its standard deviation.
struct uncertain {
  double value = 0.0, deviation = 0.0;

  [[nodiscard]] double relative_deviation() const noexcept { return deviation / std::abs(value); }
};

/// The position of a sample in a lamp's light: cosine of the angle of incidence, and distance to the lamp.
struct illumination {
  double cosine = 1.0, distance = 1.0;
};

/// The strength of a lamp from the exposure of a white reference, k_ill of Eq. 21, needed once for each lamp and camera
/// pose; or from the exposure of the lamp itself.
///
/// The note's Eq. 18 reads f = X_mat / (X_ref pi), which is f = dL / dE for a perfect diffuse reference with L_ref = E
/// / pi. A reference of reflectance rho has L_ref = rho E / pi, so the code includes rho. The note prints Eq. 19 in two
/// forms, one of which exchanges the cosines. E is proportional to cos(theta_i) / d^2, which gives Eq. 20.
class reference_light {
 public:
  /// Takes the reference's exposure per second and its deviation. Throws gonio::error unless exposure, reflectance,
  /// cosine and distance are positive and finite, and reflectance and cosine at most 1.
  reference_light(const uncertain& exposure, double reflectance, const illumination& at = {});

  /// Takes the exposure per second of the lamp itself, into which the same camera looks through a filter of this
  /// transmittance (the absolute method, Sec. 1). `solid_angle` is Omega, the lamp's solid angle in sr, seen from the
  /// sample at distance 1. A lamp of radiance L gives E = L Omega cos(theta_i), and the camera's exposure is X =
  /// transmittance k L for the lamp and k f E for the material. Throws gonio::error unless exposure, solid angle and
  /// transmittance are positive and finite, the solid angle at most 2 pi, and the transmittance at most 1.
  [[nodiscard]] static reference_light of_lamp(const uncertain& exposure, double solid_angle,
                                               double transmittance = 1.0);

  /// Returns f of a material in sr^-1 from its exposure per second at the reference's camera pose (Eq. 22). The
  /// deviation of f includes the deviations of both exposures. Throws gonio::error if `at` is unusable, as the
  /// constructor does.
  [[nodiscard]] uncertain brdf(const uncertain& exposure, const illumination& at = {}) const;

 private:
  reference_light(double per_exposure, double relative_variance)
      : per_exposure_(per_exposure), relative_variance_(relative_variance) {}
  static void require_usable(const uncertain& exposure, const char* whose);
  static void require_usable(const illumination& at);

  double per_exposure_ = 0.0, relative_variance_ = 0.0;
};

/// Returns the fraction of a lamp's light that a material reflects into a solid angle around a direction of cosine
/// `cosine_out`: the reflectance rho = f Omega cos(theta_o) of Eq. 17. With f of a perfect reference, it is Eq. 13.
[[nodiscard]] inline double reflectance_into(double brdf, double solid_angle, double cosine_out) noexcept {
  return brdf * solid_angle * cosine_out;
}

/// Returns the weight of a value of known relative deviation d: s^2 / (s^2 + d^2), where s (`unknown`) is the relative
/// error of a basis for an unknown material. Noise of a few percent hardly lowers the weight. With the weight 1 / d^2,
/// a nearly black channel would have almost no weight, and the basis would make it grey.
[[nodiscard]] inline double weight_of(double relative_deviation, double unknown = 1.0) noexcept {
  const double ratio = relative_deviation / unknown;
  return std::isfinite(relative_deviation) ? 1.0 / (1.0 + ratio * ratio) : 0.0;
}

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/relative_reflectance.ipp>
#endif
