#pragma once
/// Bodies of model/sampling_techniques.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/sampled_direction.hpp>
#include <gonio/model/analytic_brdf.hpp>
#include <gonio/model/sampling_techniques.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>
#include <vector>

namespace gonio::model::detail {

GONIO_INLINE sampling_techniques with_cosine_if_wide(const sampling_technique::density_type& density, double exponent) {
  const double share = 1.0 / (1.0 + exponent);
  return {{density, 1.0 - share}, {cosine_directions{}, share}};
}

}  // namespace gonio::model::detail

namespace gonio::model {

GONIO_INLINE sampling_techniques techniques_of(const phong_blinn::shape_type& shape) {
  const double cosine_share = std::max(detail::defensive_share, 1.0 / (1.0 + shape.shininess)),
               rest = 1.0 - cosine_share;
  return {{power_cosine_directions{.exponent = shape.shininess}, rest * (1.0 - shape.alpha)},
          {power_cosine_half_vectors{4.0 * shape.shininess}, rest * shape.alpha},
          {cosine_directions{}, cosine_share}};
}

GONIO_INLINE sampling_techniques techniques_of(const lafortune::shape_type& shape) {
  return detail::with_cosine_if_wide(
      power_cosine_directions{shape.exponent, -std::sin(shape.tilt), std::cos(shape.tilt)}, shape.exponent);
}

GONIO_INLINE sampling_techniques techniques_of(const analytic_lobe& f) {
  return detail::techniques_among<
      lambert_shape, phong_shape, blinn_phong_shape, phong_blinn_shape, with_fresnel<phong_shape>::shape,
      with_fresnel<blinn_phong_shape>::shape, with_fresnel<phong_blinn_shape>::shape, ward_shape, ward_duer_shape,
      ward_bounded_shape, anisotropic_ward_shape, anisotropic_ward_duer_shape, anisotropic_ward_bounded_shape,
      lafortune_shape, torrance_sparrow_shape, ggx_shape, anisotropic_ggx_shape>(f);
}

}  // namespace gonio::model
