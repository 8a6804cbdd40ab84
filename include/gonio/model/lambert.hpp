#pragma once
/// The ideal diffuse reflector, with the same radiance in every direction.
/// J. B. Nielsen's thesis (2016), Sec. 2.2.4; J. H. Lambert, "Photometria" (1760).

#include <gonio/core/brdf.hpp>
#include <gonio/model/lobe.hpp>

#include <array>
#include <numbers>
#include <string_view>
#include <tuple>

namespace gonio::model {

/// The BRDF f = albedo / pi above the horizon.
/// ```cpp
/// const gonio::model::lambertian grey{.albedo = gonio::rgb::Constant(0.18)};
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

/// The Lambertian model as the shape of a lobe: 1 / pi. The lobe's colour is the albedo.
template <class Real>
struct lambert_shape {
  static constexpr std::string_view name = "lambert";
  static constexpr std::array<shape_parameter, 0> parameters{};
  static auto members(auto& /*self*/) { return std::tie(); }

  [[nodiscard]] Real operator()(const lobe_geometry& /*at*/) const { return Real(std::numbers::inv_pi); }
};

static_assert(lobe_shape<lambert_shape>);

}  // namespace gonio::model
