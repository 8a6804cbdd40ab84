#pragma once
/// What an apparatus cannot do: lights on an arc, arms that must not come too close to one another or to the horizon.

#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace gonio {

/// A range of polar angles, both ends included, in radians.
struct polar_range {
  double smallest = 0.0;
  double largest = std::numbers::pi / 2.0;

  [[nodiscard]] bool contains(double theta) const noexcept { return theta >= smallest && theta <= largest; }
};

/// Settings that cannot be reached: the light in one range while the viewer is in the other.
struct forbidden_zone {
  polar_range light, viewer;
};

/// Which pairs of directions an apparatus can measure. All angles in radians; by default it can measure all. Of a
/// picture, the directions are those of its centre.
struct capture_constraint {
  polar_range light, viewer;              ///< where light and viewer can be
  double smallest_separation = 0.0;       ///< between light and viewer, which hide one another
  double light_step = 0.0;                ///< lights stand at multiples of this polar angle; 0: anywhere
  double light_tolerance = radians(0.5);  ///< by how much one may miss the light that is meant
  std::vector<forbidden_zone> forbidden;

  [[nodiscard]] bool is_none() const noexcept {
    const polar_range all;
    const auto is_all = [&](const polar_range& range) {
      return range.smallest <= all.smallest && range.largest >= all.largest;
    };
    return is_all(light) && is_all(viewer) && smallest_separation <= 0.0 && light_step <= 0.0 && forbidden.empty();
  }

  [[nodiscard]] bool operator()(const direction_pair& pair) const {
    const double theta_i = polar_angle(pair.wi), theta_o = polar_angle(pair.wo);
    if (!light.contains(theta_i) || !viewer.contains(theta_o)) return false;
    if (angle_between(pair.wi, pair.wo) < smallest_separation) return false;
    if (light_step > 0.0 && std::abs(theta_i - light_step * std::round(theta_i / light_step)) > light_tolerance)
      return false;
    return std::ranges::none_of(forbidden, [&](const forbidden_zone& zone) {
      return zone.light.contains(theta_i) && zone.viewer.contains(theta_o);
    });
  }

  /// Light and viewer with these angles between them where they can be: as the angles have them, or by reciprocity in
  /// each other's place; nothing if neither can be.
  [[nodiscard]] std::optional<direction_pair> pose_of(const half_difference& angles) const {
    const direction_pair pair = to_directions(angles), exchanged{pair.wo, pair.wi};
    if (is_none() || (*this)(pair)) return pair;
    if ((*this)(exchanged)) return exchanged;
    return {};
  }
};

}  // namespace gonio
