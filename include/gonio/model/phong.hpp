#pragma once
/// Three lobes: a cosine lobe about the mirror direction (Phong), one about the normal (Blinn-Phong), and a variant
/// between the two.
/// J. B. Nielsen, J. R. Frisvad, K. Conradsen and H. Aanaes, "Addressing Grazing Angle Reflections in Phong Models",
/// SIGGRAPH Asia 2014 posters. The normalisations are those of Akenine-Moeller, Haines and Hoffman, "Real-Time
/// Rendering", 2008.

#include <gonio/model/lobe.hpp>

#include <numbers>

namespace gonio::model {

namespace detail {

inline constexpr shape_parameter shininess_bounds{"shininess", "", 0.01, 1e6, 50.0, true};

/// Returns base^exponent; zero if the base is negative.
template <class Base, class Real>
[[nodiscard]] Real cosine_power(const Base& base, const Real& exponent) {
  using std::exp, std::log;
  if (!(base > 0.0)) return Real(0.0);
  return exp(Real(exponent * log(base)));
}

}  // namespace detail

/// Modified Phong: (s + 2) / (2 pi) (wr . wo)^s, where wr is the mirror direction of wi. 2014, Eq. 1.
template <class Real>
struct phong_shape {
  static constexpr std::string_view name = "phong";
  static constexpr std::array parameters{detail::shininess_bounds};
  static auto members(auto& self) { return std::tie(self.shininess); }

  Real shininess = Real(detail::shininess_bounds.typical);  ///< s

  [[nodiscard]] Real operator()(const lobe_geometry& at) const {
    return (shininess + 2.0) * (0.5 * std::numbers::inv_pi) * detail::cosine_power(at.mirrored_cosine(), shininess);
  }
};
static_assert(lobe_shape<phong_shape>);

/// Modified Blinn-Phong: (s + 8) / (8 pi) (h . n)^s. 2014, Eq. 2; thesis Eq. 2.16.
template <class Real>
struct blinn_phong_shape {
  static constexpr std::string_view name = "blinn-phong";
  static constexpr std::array parameters{detail::shininess_bounds};
  static auto members(auto& self) { return std::tie(self.shininess); }

  Real shininess = Real(detail::shininess_bounds.typical);  ///< s

  [[nodiscard]] Real operator()(const lobe_geometry& at) const {
    return (shininess + 8.0) * (0.125 * std::numbers::inv_pi) * detail::cosine_power(at.h.z(), shininess);
  }
};
static_assert(lobe_shape<blinn_phong_shape>);

/// The variant between Phong and Blinn-Phong: ((1 - alpha) (wr . wo) + alpha (h . n)^4)^s. 2014, Eq. 3. It has no
/// normalisation, so its colour is the paper's k_s. A negative base counts as zero.
template <class Real>
struct phong_blinn_shape {
  static constexpr std::string_view name = "phong-blinn";
  static constexpr std::array parameters{detail::shininess_bounds, shape_parameter{"alpha", "", 0.0, 1.0, 0.5}};
  static auto members(auto& self) { return std::tie(self.shininess, self.alpha); }

  Real shininess = Real(detail::shininess_bounds.typical);  ///< s
  Real alpha = Real(0.5);                                   ///< 0: like Phong, 1: like Blinn-Phong with exponent 4 s

  [[nodiscard]] Real operator()(const lobe_geometry& at) const {
    const double squared = at.h.z() * at.h.z(), mirrored = at.mirrored_cosine();
    const Real base = mirrored + alpha * (squared * squared - mirrored);
    return detail::cosine_power(base, shininess);
  }
};
static_assert(lobe_shape<phong_blinn_shape>);

using phong = lobe<phong_shape>;
using blinn_phong = lobe<blinn_phong_shape>;
using phong_blinn = lobe<phong_blinn_shape>;

static_assert(brdf<phong> && brdf<blinn_phong> && brdf<phong_blinn>);

}  // namespace gonio::model
