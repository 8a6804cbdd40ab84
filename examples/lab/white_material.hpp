#pragma once
/// A white reference.

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>

#include <numbers>

namespace lab {

/// A Lambertian surface.
struct white_material {
  double reflectance = 1.0;

  [[nodiscard]] gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return gonio::rgb::Zero();
    return gonio::rgb::Constant(reflectance / std::numbers::pi);
  }
};

}  // namespace lab
