#pragma once
/// The concept of a BRDF, which tables, analytic models and fits satisfy.

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>

#include <concepts>

namespace gonio {

/// A bidirectional reflectance distribution function: `f(wi, wo) -> rgb` in sr^-1.
///
/// Requirements that the compiler cannot check:
/// - `wi` (towards the light) and `wo` (towards the viewer) are unit vectors in the local frame, normal +z;
/// - the value does not contain the cosine of the incident angle;
/// - it is zero if either direction is at or below the horizon;
/// - it is finite and reciprocal (f(wi, wo) = f(wo, wi)) up to rounding;
/// - it is isotropic up to rounding, unless its type declares that it may be anisotropic. An anisotropic material has
///   the axes of the local frame. Do not pass it to code that needs an isotropic one, like a table over half and
///   difference angles;
/// - evaluation is thread safe, does not allocate and does not throw.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/core/brdf.hpp>
/// #include <gonio/model/lambert.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::model::lambertian grey{.albedo = gonio::rgb::Constant(0.18)};
///   const gonio::direction light = gonio::direction(1, 0, 1).normalized(), viewer(0, 0, 1);
///   std::printf("%g per steradian\n", grey(light, viewer).x());
/// }
/// ```
/// With a model of your own:
/// ```cpp
/// #include <gonio/core/brdf.hpp>
/// #include <gonio/table/brdf_table.hpp>
///
/// #include <cstdio>
/// #include <numbers>
///
/// struct white_lambertian {
///   gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
///     return gonio::rgb::Constant(wi.z() > 0 && wo.z() > 0 ? std::numbers::inv_pi : 0.0);
///   }
/// };
/// static_assert(gonio::brdf<white_lambertian>);
///
/// int main() {
///   const gonio::brdf_table table = gonio::tabulate(white_lambertian{}, gonio::valid_cells());
///   std::printf("%g per steradian\n", table.at(0).x());
/// }
/// ```
template <class F>
concept brdf = requires(const F& f, const direction& wi, const direction& wo) {
  { f(wi, wo) }
  noexcept->std::convertible_to<rgb>;
};

/// A reference to a BRDF, such as a table of many megabytes that two objects share. The BRDF must outlive the
/// reference.
template <class Brdf>
class brdf_view {
 public:
  explicit brdf_view(const Brdf& f) noexcept : f_(&f) {}

  /// Evaluates the BRDF. Accepts directions of any type that the BRDF accepts.
  template <class Direction>
  [[nodiscard]] auto operator()(const Direction& wi, const Direction& wo) const noexcept {
    return (*f_)(wi, wo);
  }

 private:
  const Brdf* f_;
};

}  // namespace gonio
