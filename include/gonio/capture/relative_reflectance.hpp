#pragma once
/// From exposures of a material and of a white reference to the BRDF: the relative method (Nielsen's thesis 2016, note
/// on relative BRDF measurement, Sec. 2, 4 and 5).

#include <gonio/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace gonio {

/// The solid angle in sr of a lens of effective diameter D = f / F from a distance r, which is what a pixel receives
/// (Eq. 4 and 5). All lengths in the same unit. Throws gonio::error unless all are positive and finite.
[[nodiscard]] inline double pixel_solid_angle(double focal_length, double f_number, double distance) {
  for (const double number : {focal_length, f_number, distance})
    if (!(number > 0.0 && std::isfinite(number)))
      throw error("focal length, f-number and distance must be positive, not " + std::to_string(number));
  const double tangent = focal_length / f_number / (2.0 * distance);
  const double hypotenuse = std::hypot(1.0, tangent);
  // 1 - 1 / h as (h^2 - 1) / (h (h + 1)): a lens far away loses no digits.
  return 2.0 * std::numbers::pi * tangent * tangent / (hypotenuse * (hypotenuse + 1.0));
}

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
  reference_light(const uncertain& exposure, double reflectance, const illumination& at = {})
      : relative_variance_(std::pow(exposure.relative_deviation(), 2)) {
    const auto require = [](bool holds, const char* what, double number) {
      if (!holds) throw error(std::string(what) + ", not " + std::to_string(number));
    };
    require(exposure.value > 0.0 && std::isfinite(exposure.value), "the reference's exposure must be positive",
            exposure.value);
    require(exposure.deviation >= 0.0 && std::isfinite(exposure.deviation),
            "the deviation of the reference's exposure must be finite and not negative", exposure.deviation);
    require(reflectance > 0.0 && reflectance <= 1.0, "a reference's reflectance lies above 0 and up to 1", reflectance);
    require_usable(at);
    per_exposure_ = reflectance * at.cosine / (std::numbers::pi * exposure.value * at.distance * at.distance);
  }

  /// f of a material in sr^-1 from its exposure at the same time and camera pose (Eq. 22), with the deviation that both
  /// exposures cause. Throws as the constructor does for where the material lies.
  [[nodiscard]] uncertain brdf(const uncertain& exposure, const illumination& at = {}) const {
    require_usable(at);
    const double scale = per_exposure_ * at.distance * at.distance / at.cosine;
    const double value = scale * exposure.value;
    return {value, std::sqrt(std::pow(scale * exposure.deviation, 2) + value * value * relative_variance_)};
  }

 private:
  static void require_usable(const illumination& at) {
    if (!(at.cosine > 0.0 && at.cosine <= 1.0))
      throw error("the cosine of the angle of incidence lies above 0 and up to 1, not " + std::to_string(at.cosine));
    if (!(at.distance > 0.0 && std::isfinite(at.distance)))
      throw error("the distance to the lamp must be positive, not " + std::to_string(at.distance));
  }

  double per_exposure_ = 0.0, relative_variance_ = 0.0;
};

/// The share of a lamp's light that a material sends into a solid angle around a direction of cosine `cosine_out`: the
/// reflectance of Eq. 17, rho = f Omega cos(theta_o). With f of a perfect reference it is Eq. 13.
[[nodiscard]] inline double reflectance_into(double brdf, double solid_angle, double cosine_out) noexcept {
  return brdf * solid_angle * cosine_out;
}

/// How much a sample counts whose relative deviation is known: 1 up to the smallest deviation that a fit can make use
/// of, then less with its square, since a metric's error is one of the logarithm, or close to it.
[[nodiscard]] inline double weight_of(double relative_deviation, double smallest = 0.01) noexcept {
  const double ratio = smallest / std::max(relative_deviation, smallest);
  return std::isfinite(relative_deviation) ? ratio * ratio : 0.0;
}

}  // namespace gonio
