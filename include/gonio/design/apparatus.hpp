#pragma once
/// An apparatus: where its light and viewer can be, and how well it measures there.

#include <gonio/design/capture_constraint.hpp>

namespace gonio::design {

/// By default an apparatus without limits and without errors.
struct apparatus {
  capture_constraint constraint;
  double noise = 0.0;  ///< deviation of a reading relative to it: 0.02 is 2 %
  /// Deviation of a reading without light, as BRDF times the cosines of light and viewer, sr^-1: at grazing angles a
  /// reading is small, and this is much of it.
  double dark_signal = 0.0;
  double angular_error = 0.0;  ///< radians by which light and viewer may each be off their directions
};

/// What a goniometer can do unless somebody says more: light and viewer up to 80 degrees and 5 degrees apart, because a
/// lamp and a receiver have a size; readings are good to 2 % and to 0.0001 sr^-1 times both cosines.
[[nodiscard]] apparatus usual_apparatus();

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/apparatus.ipp>
#endif
