#pragma once
/// Bodies of capture/relative_reflectance.hpp.

#include <gonio/capture/relative_reflectance.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace gonio::capture {

GONIO_INLINE double pixel_half_angle(double focal_length, double f_number, double distance) {
  for (const double number : {focal_length, f_number, distance})
    if (!(number > 0.0 && std::isfinite(number)))
      refuse("focal length, f-number and distance must be positive, not " + std::to_string(number));
  return std::atan(focal_length / f_number / (2.0 * distance));
}

GONIO_INLINE double pixel_solid_angle(double focal_length, double f_number, double distance) {
  // 1 - cos(omega) as 2 sin^2(omega / 2), which loses no digits for a distant lens.
  return 4.0 * std::numbers::pi * std::pow(std::sin(pixel_half_angle(focal_length, f_number, distance) / 2.0), 2);
}

GONIO_INLINE reference_light::reference_light(const uncertain& exposure, double reflectance, const illumination& at)
    : relative_variance_(std::pow(exposure.relative_deviation(), 2)) {
  require_usable(exposure, "reference");
  if (!(reflectance > 0.0 && reflectance <= 1.0))
    refuse("a reference's reflectance must be above 0 and up to 1, not " + std::to_string(reflectance));
  require_usable(at);
  per_exposure_ = reflectance * at.cosine / (std::numbers::pi * exposure.value * at.distance * at.distance);
}

GONIO_INLINE reference_light reference_light::of_lamp(const uncertain& exposure, double solid_angle,
                                                      double transmittance) {
  require_usable(exposure, "lamp");
  if (!(solid_angle > 0.0 && solid_angle <= 2.0 * std::numbers::pi))
    refuse("a lamp's solid angle must be above 0 and up to 2 pi sr, not " + std::to_string(solid_angle));
  if (!(transmittance > 0.0 && transmittance <= 1.0))
    refuse("a filter's transmittance must be above 0 and up to 1, not " + std::to_string(transmittance));
  return {transmittance / (exposure.value * solid_angle), std::pow(exposure.relative_deviation(), 2)};
}

GONIO_INLINE uncertain reference_light::brdf(const uncertain& exposure, const illumination& at) const {
  require_usable(at);
  const double scale = per_exposure_ * at.distance * at.distance / at.cosine;
  const double value = scale * exposure.value;
  return {value, std::sqrt(std::pow(scale * exposure.deviation, 2) + value * value * relative_variance_)};
}

GONIO_INLINE void reference_light::require_usable(const uncertain& exposure, const char* whose) {
  const std::string owner = std::string("the ") + whose + "'s exposure";
  if (!(exposure.value > 0.0 && std::isfinite(exposure.value)))
    refuse(owner + " must be positive, not " + std::to_string(exposure.value));
  if (!(exposure.deviation >= 0.0 && std::isfinite(exposure.deviation)))
    refuse("the deviation of " + owner + " must be finite and not negative, not " + std::to_string(exposure.deviation));
}

GONIO_INLINE void reference_light::require_usable(const illumination& at) {
  if (!(at.cosine > 0.0 && at.cosine <= 1.0))
    refuse("the cosine of the angle of incidence must be above 0 and up to 1, not " + std::to_string(at.cosine));
  if (!(at.distance > 0.0 && std::isfinite(at.distance)))
    refuse("the distance to the lamp must be positive, not " + std::to_string(at.distance));
}

}  // namespace gonio::capture
