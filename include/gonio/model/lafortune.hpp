#pragma once
/// Generalised cosine lobes. E. P. F. Lafortune, S.-C. Foo, K. E. Torrance and D. P. Greenberg, "Non-Linear
/// Approximation of Reflectance Functions", SIGGRAPH 1997 (doi:10.1145/258734.258801); J. B. Nielsen's thesis, Eq.
/// 2.18.

#include <gonio/model/phong.hpp>

namespace gonio::model {

/// (wi' M wo / |M|)^n with the isotropic M = diag(-sin tilt, -sin tilt, cos tilt); in the paper's terms C_x = -sin tilt
/// and C_z = cos tilt. The shape does not have the paper's common scale of C_x and C_z, which would only scale the
/// colour. |M| is the larger of |C_x| and |C_z|; dividing by it makes the colour the lobe's largest reflectance.
/// `sum_of_lobes` adds several lobes.
template <class Real>
struct lafortune_shape {
  static constexpr std::string_view name = "lafortune";
  static constexpr std::array parameters{
      shape_parameter{"tilt", "rad", -std::numbers::pi / 2, std::numbers::pi / 2, std::numbers::pi / 4},
      shape_parameter{"exponent", "", 0.01, 1e6, 20.0, true}};
  static auto members(auto& self) { return std::tie(self.tilt, self.exponent); }

  /// The lobe's direction. pi / 4 gives Phong's lobe about the mirror direction, a larger tilt a lobe towards grazing
  /// angles, 0 a diffuse lobe, a negative tilt a lobe back to the light.
  Real tilt = Real(std::numbers::pi / 4);
  Real exponent = Real(20.0);  ///< n

  [[nodiscard]] Real operator()(const lobe_geometry& at) const {
    using std::cos, std::sin;
    const Real along = cos(tilt), within = sin(tilt);
    const Real largest = along > within ? (along > -within ? along : Real(-within)) : within;
    const Real base = (along * (at.cosine_i * at.cosine_o) - within * at.tangential) / largest;
    return detail::cosine_power(base, exponent);
  }
};
static_assert(lobe_shape<lafortune_shape>);

using lafortune = lobe<lafortune_shape>;

static_assert(brdf<lafortune>);

}  // namespace gonio::model
