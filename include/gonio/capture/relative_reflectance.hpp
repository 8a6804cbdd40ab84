#pragma once
/// The relative method: computes the BRDF from exposures of a material and of a white reference (Nielsen's thesis 2016,
/// note on relative BRDF measurement, Sec. 2, 4 and 5).

#include <gonio/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace gonio::capture {

/// Returns the solid angle in sr of a lens of effective diameter D = f / F at a distance r, from which a pixel receives
/// light (Eq. 4 and 5). All lengths are in the same unit. Throws gonio::error unless all are positive and finite.
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

/// The strength of a lamp from the exposure of a white reference: k_ill of Eq. 21, once for each lamp and camera pose.
///
/// The note's Eq. 18 reads f = X_mat / (X_ref pi), which is f = dL / dE for a perfect diffuse reference, L_ref = E /
/// pi. A reference of reflectance rho has L_ref = rho E / pi, so the code includes rho. As printed, one of the two
/// forms of Eq. 19 has the cosines exchanged. E is proportional to cos(theta_i) / d^2, which gives Eq. 20.
class reference_light {
 public:
  /// Takes the reference's exposure per second and its deviation. Throws gonio::error unless exposure, reflectance,
  /// cosine and distance are positive and finite, and reflectance and cosine at most 1.
  reference_light(const uncertain& exposure, double reflectance, const illumination& at = {});

  /// Returns f of a material in sr^-1 from its exposure at the same time and camera pose (Eq. 22), with the deviation
  /// due to both exposures. Throws gonio::error if `at` is unusable, as the constructor does.
  [[nodiscard]] uncertain brdf(const uncertain& exposure, const illumination& at = {}) const;

 private:
  static void require_usable(const illumination& at);

  double per_exposure_ = 0.0, relative_variance_ = 0.0;
};

/// Returns the fraction of a lamp's light that a material reflects into a solid angle around a direction of cosine
/// `cosine_out`: the reflectance of Eq. 17, rho = f Omega cos(theta_o). With f of a perfect reference it is Eq. 13.
[[nodiscard]] inline double reflectance_into(double brdf, double solid_angle, double cosine_out) noexcept {
  return brdf * solid_angle * cosine_out;
}

/// Returns the weight of a value of known relative deviation d: s^2 / (s^2 + d^2), because variances of the logarithm
/// add up. s is the error of a basis for an unknown material. Noise of a few percent therefore hardly reduces a
/// sample's weight. A nearly black channel keeps some weight even if its value is all noise. A weight of 1 / d^2 would
/// leave that channel to the basis, which expects grey.
[[nodiscard]] inline double weight_of(double relative_deviation, double unknown = 1.0) noexcept {
  const double ratio = relative_deviation / unknown;
  return std::isfinite(relative_deviation) ? 1.0 / (1.0 + ratio * ratio) : 0.0;
}

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/relative_reflectance.ipp>
#endif
