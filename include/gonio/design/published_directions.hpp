#pragma once
/// Directions recommended in the literature, as data. Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Table 1: the n
/// directions on MERL's grid with the best condition number; Table 2: the best n images of a sphere. Westlund and Meyer
/// 2001, "Applying Appearance Standards to Light Reflection Models": the directions measured in industry.

#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace gonio::design {

namespace detail {

/// theta_h, theta_d, phi_d in degrees, as printed.
using printed_direction = std::array<int, 3>;

const std::vector<std::vector<printed_direction>>& nielsen_table_1();

}  // namespace detail

/// The sizes of the sets in Nielsen et al. 2015.
inline constexpr std::array<Eigen::Index, 5> nielsen_direction_counts{1, 2, 5, 10, 20};

/// Returns true if there is a set of n directions.
[[nodiscard]] constexpr bool has_nielsen_directions(Eigen::Index n) {
  return std::ranges::find(nielsen_direction_counts, n) != nielsen_direction_counts.end();
}

/// Nielsen et al. 2015, Table 1, in radians. Throws gonio::error unless n is 1, 2, 5, 10 or 20.
[[nodiscard]] std::vector<half_difference> nielsen_directions(Eigen::Index n);

/// Nielsen et al. 2015, Table 2, in radians: n images of a sphere. All samples of an image have the theta_d given here,
/// half the angle between light and camera. theta_h = phi_d = 0 is the point whose normal is midway between light and
/// camera. Throws gonio::error unless n is 1, 2 or 5.
[[nodiscard]] std::vector<half_difference> nielsen_sphere_directions(Eigen::Index n);

/// The five measurements of industrial goniospectrophotometers (Westlund and Meyer 2001), in radians. The light is at
/// 45 degrees. The viewer is in the plane of incidence, 15, 25, 45, 75 and 110 degrees from the mirror direction
/// towards the light.
[[nodiscard]] std::vector<half_difference> westlund_meyer_directions();

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/published_directions.ipp>
#endif
