#pragma once
/// A light so far away that its direction is the same everywhere.

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>

namespace gonio {

struct directional_light {
  /// Towards the light.
  direction towards;
  /// Radiance times solid angle: the irradiance of a surface that faces the light.
  rgb irradiance = rgb::Ones();
  /// Under which it is seen, radians.
  double half_angle = 0.0;
};

}  // namespace gonio
