#pragma once
/// Bodies of model/analytic_brdf.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/model/analytic_brdf.hpp>
#include <gonio/model/fresnel_lobe.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/lafortune.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/model/phong.hpp>
#include <gonio/model/torrance_sparrow.hpp>
#include <gonio/model/ward.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::model {

GONIO_INLINE std::span<const lobe_kind* const> lobe_kinds() {
  static const std::array all{&lobe_kind::of<lambert_shape>(),
                              &lobe_kind::of<phong_shape>(),
                              &lobe_kind::of<blinn_phong_shape>(),
                              &lobe_kind::of<phong_blinn_shape>(),
                              &lobe_kind::of<with_fresnel<phong_shape>::shape>(),
                              &lobe_kind::of<with_fresnel<blinn_phong_shape>::shape>(),
                              &lobe_kind::of<with_fresnel<phong_blinn_shape>::shape>(),
                              &lobe_kind::of<ward_shape>(),
                              &lobe_kind::of<ward_duer_shape>(),
                              &lobe_kind::of<ward_bounded_shape>(),
                              &lobe_kind::of<lafortune_shape>(),
                              &lobe_kind::of<torrance_sparrow_shape>(),
                              &lobe_kind::of<ggx_shape>()};
  return all;
}

GONIO_INLINE std::span<const lobe_kind* const> anisotropic_lobe_kinds() {
  static const std::array all{&lobe_kind::of<anisotropic_ward_shape>(), &lobe_kind::of<anisotropic_ward_duer_shape>(),
                              &lobe_kind::of<anisotropic_ward_bounded_shape>(),
                              &lobe_kind::of<anisotropic_ggx_shape>()};
  return all;
}

GONIO_INLINE const lobe_kind& lobe_kind_named(std::string_view name) {
  std::string known;
  for (const std::span<const lobe_kind* const> kinds : {lobe_kinds(), anisotropic_lobe_kinds()})
    for (const lobe_kind* kind : kinds) {
      if (kind->name() == name) return *kind;
      known += (known.empty() ? "" : ", ") + std::string(kind->name());
    }
  refuse("there is no lobe named '" + std::string(name) + "'; the names are " + known);
}

GONIO_INLINE analytic_lobe::analytic_lobe(const lobe_kind& kind, const rgb& colour, const lobe_kind::values& parameters)
    : kind_(&kind), colour_(colour), parameters_(parameters) {
  require_usable_colour(kind.name(), colour_);
  for (Eigen::Index i = 0; i < std::ssize(kind.parameters()); ++i)
    require_within_bounds(kind.name(), kind.parameters()[i], parameters_[i]);
}

}  // namespace gonio::model
