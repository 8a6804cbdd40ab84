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

GONIO_INLINE double pixel_solid_angle(double focal_length, double f_number, double distance) {
  for (const double number : {focal_length, f_number, distance})
    if (!(number > 0.0 && std::isfinite(number)))
      refuse("focal length, f-number and distance must be positive, not " + std::to_string(number));
  const double tangent = focal_length / f_number / (2.0 * distance);
  const double hypotenuse = std::hypot(1.0, tangent);
  // 1 - 1 / h as (h^2 - 1) / (h (h + 1)), which loses no digits for a distant lens.
  return 2.0 * std::numbers::pi * tangent * tangent / (hypotenuse * (hypotenuse + 1.0));
}

GONIO_INLINE reference_light::reference_light(const uncertain& exposure, double reflectance, const illumination& at)
    : relative_variance_(std::pow(exposure.relative_deviation(), 2)) {
  const auto require = [](bool holds, const char* what, double number) {
    if (!holds) refuse(std::string(what) + ", not " + std::to_string(number));
  };
  require(exposure.value > 0.0 && std::isfinite(exposure.value), "the reference's exposure must be positive",
          exposure.value);
  require(exposure.deviation >= 0.0 && std::isfinite(exposure.deviation),
          "the deviation of the reference's exposure must be finite and not negative", exposure.deviation);
  require(reflectance > 0.0 && reflectance <= 1.0, "a reference's reflectance must be above 0 and up to 1",
          reflectance);
  require_usable(at);
  per_exposure_ = reflectance * at.cosine / (std::numbers::pi * exposure.value * at.distance * at.distance);
}

GONIO_INLINE uncertain reference_light::brdf(const uncertain& exposure, const illumination& at) const {
  require_usable(at);
  const double scale = per_exposure_ * at.distance * at.distance / at.cosine;
  const double value = scale * exposure.value;
  return {value, std::sqrt(std::pow(scale * exposure.deviation, 2) + value * value * relative_variance_)};
}

GONIO_INLINE void reference_light::require_usable(const illumination& at) {
  if (!(at.cosine > 0.0 && at.cosine <= 1.0))
    refuse("the cosine of the angle of incidence must be above 0 and up to 1, not " + std::to_string(at.cosine));
  if (!(at.distance > 0.0 && std::isfinite(at.distance)))
    refuse("the distance to the lamp must be positive, not " + std::to_string(at.distance));
}

}  // namespace gonio::capture
