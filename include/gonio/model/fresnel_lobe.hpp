#pragma once
/// Any lobe times the reflectance of a smooth dielectric surface. J. B. Nielsen et al. 2014 multiply the specular
/// reflectance by R_F(wi . wh, eta).

#include <gonio/core/fresnel.hpp>
#include <gonio/model/phong.hpp>
#include <gonio/model/ward.hpp>

#include <Eigen/Core>

namespace gonio::model {

/// `with_fresnel<Shape>::shape` is Shape times `fresnel_dielectric`; its last parameter is the refractive index.
template <template <class> class Shape>
struct with_fresnel {
  template <class Real>
  struct shape {
    static constexpr Eigen::Index count = parameter_count<Shape> + 1;
    static constexpr auto parameters = [] {
      std::array<shape_parameter, count> all{};
      std::ranges::copy(Shape<double>::parameters, all.begin());
      all.back() = {"refractive_index", "", 1.01, 4.0, 1.5};
      return all;
    }();
    static constexpr std::string_view suffix = "-fresnel";
    static constexpr auto letters = [] {
      std::array<char, Shape<double>::name.size() + suffix.size()> all{};
      std::ranges::copy(suffix, std::ranges::copy(Shape<double>::name, all.begin()).out);
      return all;
    }();
    static constexpr std::string_view name{letters.data(), letters.size()};
    static auto members(auto& self) {
      return std::tuple_cat(Shape<Real>::members(self.lobe), std::tie(self.refractive_index));
    }

    Shape<Real> lobe = {};
    Real refractive_index = Real(1.5);  ///< eta

    [[nodiscard]] Real operator()(const lobe_geometry& at) const {
      return lobe(at) * fresnel_dielectric(at.cosine_d, refractive_index);
    }
  };
};

using phong_fresnel = lobe<with_fresnel<phong_shape>::shape>;
using blinn_phong_fresnel = lobe<with_fresnel<blinn_phong_shape>::shape>;
using phong_blinn_fresnel = lobe<with_fresnel<phong_blinn_shape>::shape>;

static_assert(lobe_shape<with_fresnel<phong_shape>::shape>);
static_assert(brdf<phong_fresnel> && brdf<blinn_phong_fresnel> && brdf<phong_blinn_fresnel>);

}  // namespace gonio::model
