#pragma once
/// Bodies of design/capture_constraint.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/design/capture_constraint.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace gonio::design {

GONIO_INLINE bool capture_constraint::is_none() const noexcept {
  const polar_range all;
  const auto is_all = [&](const polar_range& range) {
    return range.smallest <= all.smallest && range.largest >= all.largest;
  };
  return is_all(light) && is_all(viewer) && smallest_separation <= 0.0 && light_step <= 0.0 && forbidden.empty();
}

GONIO_INLINE bool capture_constraint::operator()(const direction_pair& pair) const {
  const double theta_i = polar_angle(pair.wi), theta_o = polar_angle(pair.wo);
  if (!light.contains(theta_i) || !viewer.contains(theta_o)) return false;
  if (angle_between(pair.wi, pair.wo) < smallest_separation) return false;
  if (light_step > 0.0 && std::abs(theta_i - light_step * std::round(theta_i / light_step)) > light_tolerance)
    return false;
  return std::ranges::none_of(forbidden, [&](const forbidden_zone& zone) {
    return zone.light.contains(theta_i) && zone.viewer.contains(theta_o);
  });
}

GONIO_INLINE std::optional<direction_pair> capture_constraint::pose_of(const half_difference& angles) const {
  const direction_pair pair = to_directions(angles), exchanged{pair.wo, pair.wi};
  if (is_none() || (*this)(pair)) return pair;
  if ((*this)(exchanged)) return exchanged;
  return {};
}

}  // namespace gonio::design
