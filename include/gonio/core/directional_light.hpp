#pragma once
/// A light at infinity, whose direction is the same everywhere.

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>

namespace gonio {

struct directional_light {
  /// Towards the light.
  direction towards;
  /// The irradiance on a surface that faces the light: radiance times solid angle.
  rgb irradiance = rgb::Ones();
  /// The half angle of the light as seen from the surface, radians.
  double half_angle = 0.0;
};

}  // namespace gonio
