#pragma once
/// The ideal diffuse reflector: the same radiance in every direction.
/// J. B. Nielsen's thesis (2016), Sec. 2.2.4; J. H. Lambert, "Photometria" (1760).

#include <gonio/core/brdf.hpp>

#include <numbers>

namespace gonio {

/// f = albedo / pi above the horizon.
/// ```cpp
/// const gonio::lambertian grey{.albedo = gonio::rgb::Constant(0.18)};
/// ```
struct lambertian {
  /// The fraction of the incident light that is reflected, in [0, 1] for a physical surface.
  rgb albedo = rgb::Ones();

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
    return albedo * std::numbers::inv_pi;
  }
};

static_assert(brdf<lambertian>);

}  // namespace gonio
