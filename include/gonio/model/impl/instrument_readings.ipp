#pragma once
/// Bodies of model/instrument_readings.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/model/instrument_readings.hpp>

#include <cmath>

namespace gonio::model {

GONIO_INLINE reflectometer gloss_meter(int degrees) {
  const auto meter = [degrees](double in_plane, double across) {
    return reflectometer{.theta_i = radians(degrees),
                         .source = {radians(0.75), radians(2.5)},
                         .receptor = {radians(in_plane), radians(across)}};
  };
  switch (degrees) {
    case 20:
      return meter(1.8, 3.6);
    case 60:
      return meter(4.4, 11.7);
    case 85:
      return meter(4.0, 6.0);
    default:
      refuse({"a gloss meter of ", degrees, " degrees is unknown, expected 20, 60 or 85"});
  }
}

GONIO_INLINE reflectometer haze_meter(int side) {
  if (side != -1 && side != 1) refuse({"side ", side, " of the mirror direction is unknown, expected -1 or 1"});
  reflectometer meter = gloss_meter(20);
  meter.off_mirror = side * radians(1.9);
  meter.receptor = {radians(1.8), radians(5.5)};
  return meter;
}

GONIO_INLINE double gloss_standard_reflectance(double theta_i) {
  constexpr double refractive_index = 1.567;
  return fresnel_dielectric(std::cos(theta_i), refractive_index);
}

GONIO_INLINE direction_pair aspecular_directions(double aspecular) {
  const double incidence = radians(45.0);
  return {detail::tilted(-incidence, 0.0), detail::tilted(incidence - radians(aspecular), 0.0)};
}

}  // namespace gonio::model
