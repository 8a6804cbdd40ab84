#pragma once
/// The concept every reflectance in the library models: tables, analytic models, fits.

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>

#include <concepts>

namespace gonio {

/// A bidirectional reflectance distribution function: `f(wi, wo) -> rgb` in sr^-1.
///
/// What the compiler cannot check, and a model must keep:
/// - `wi` (towards the light) and `wo` (towards the viewer) are unit vectors in the local frame, normal +z;
/// - the value never contains the cosine of the incident angle;
/// - it is zero where either direction is at or below the horizon;
/// - it is finite, reciprocal (f(wi, wo) = f(wo, wi)) and isotropic up to rounding;
/// - evaluation is thread safe, does not allocate and does not throw.
///
/// The smallest model:
/// ```cpp
/// struct white_lambertian {
///   gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
///     return gonio::rgb::Constant(wi.z() > 0 && wo.z() > 0 ? std::numbers::inv_pi : 0.0);
///   }
/// };
/// static_assert(gonio::brdf<white_lambertian>);
/// ```
template <class F>
concept brdf = requires(const F& f, const direction& wi, const direction& wo) {
  { f(wi, wo) }
  noexcept->std::convertible_to<rgb>;
};

}  // namespace gonio
