#pragma once
/// An apparatus: the directions that its light and viewer can reach, and its measurement errors.

#include <gonio/design/capture_constraint.hpp>

namespace gonio::design {

/// The default apparatus has no limits and no errors.
struct apparatus {
  capture_constraint constraint;
  double noise = 0.0;  ///< standard deviation of a reading, relative to the reading: 0.02 is 2 %
  /// Standard deviation of a reading without light, as BRDF times the cosines of light and viewer, in sr^-1. At grazing
  /// angles, where readings are small, it is a large fraction of them.
  double dark_signal = 0.0;
  double angular_error = 0.0;  ///< in radians: the error of the light's and of the viewer's direction
};

/// Returns a typical goniometer. Light and viewer reach 80 degrees and stay at least 5 degrees apart, because lamp and
/// receiver have a size. Readings have 2 % noise and a dark signal of 0.0001 sr^-1.
[[nodiscard]] apparatus usual_apparatus();

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/apparatus.ipp>
#endif
