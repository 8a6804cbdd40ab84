#pragma once
/// Bodies of design/capture_constraint.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/design/capture_constraint.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace gonio::design::detail {

/// Returns the angle between the viewer and the plane of light and normal; 0 if the light is at the normal.
[[nodiscard]] GONIO_INLINE double angle_from_plane(const direction_pair& pair) {
  const direction across(-pair.wi.y(), pair.wi.x(), 0.0);
  const double length = across.norm();
  if (length < 1e-9) return 0.0;
  return std::asin(std::clamp(std::abs(pair.wo.dot(across)) / length, 0.0, 1.0));
}

}  // namespace gonio::design::detail

namespace gonio::design {

GONIO_INLINE bool capture_constraint::is_none() const noexcept {
  const polar_range all;
  const auto is_all = [&](const polar_range& range) {
    return range.smallest <= all.smallest && range.largest >= all.largest;
  };
  return is_all(light) && is_all(viewer) && smallest_separation <= 0.0 && light_step <= 0.0 && forbidden.empty() &&
         !plane_tolerance && pairs.empty();
}

GONIO_INLINE bool capture_constraint::operator()(const direction_pair& pair) const {
  const double theta_i = polar_angle(pair.wi), theta_o = polar_angle(pair.wo);
  if (!light.contains(theta_i) || !viewer.contains(theta_o)) return false;
  if (angle_between(pair.wi, pair.wo) < smallest_separation) return false;
  if (light_step > 0.0 && std::abs(theta_i - light_step * std::round(theta_i / light_step)) > light_tolerance)
    return false;
  if (plane_tolerance && detail::angle_from_plane(pair) > *plane_tolerance + 1e-9) return false;
  if (!pairs.empty() && !fixed_pair(pair)) return false;
  return std::ranges::none_of(forbidden, [&](const forbidden_zone& zone) {
    return zone.light.contains(theta_i) && zone.viewer.contains(theta_o);
  });
}

GONIO_INLINE std::optional<direction_pair> capture_constraint::pose_of(const half_difference& angles) const {
  half_difference within = angles;
  if (plane_tolerance) within.phi_d = 0.0;
  const direction_pair pair = to_directions(within), exchanged{pair.wo, pair.wi};
  if (is_none() || (*this)(pair)) return pair;
  if ((*this)(exchanged)) return exchanged;
  return {};
}

GONIO_INLINE std::optional<std::size_t> capture_constraint::fixed_pair(const direction_pair& pair) const {
  constexpr double tolerance = radians(0.5);
  // The reflectance of an isotropic material does not change if a pair is turned about the normal or mirrored.
  const auto across = [](const direction_pair& of) {
    return std::abs(std::remainder(azimuth(of.wo) - azimuth(of.wi), 2.0 * std::numbers::pi));
  };
  const auto meets = [&](const direction_pair& fixed) {
    const double of_light = polar_angle(fixed.wi), of_viewer = polar_angle(fixed.wo);
    return std::abs(polar_angle(pair.wi) - of_light) <= tolerance &&
           std::abs(polar_angle(pair.wo) - of_viewer) <= tolerance &&
           std::abs(across(pair) - across(fixed)) * std::sin(std::min(of_light, of_viewer)) <= tolerance;
  };
  const auto found = std::ranges::find_if(pairs, [&](const direction_pair& fixed) {
    return meets(fixed) || meets({fixed.wo, fixed.wi});
  });
  if (found == pairs.end()) return {};
  return static_cast<std::size_t>(found - pairs.begin());
}

GONIO_INLINE std::string capture_constraint::excluding_rule(
    const std::function<bool(const capture_constraint&)>& leaves_some) const {
  capture_constraint some;
  const auto excludes = [&](auto... members) {
    ((some.*members = this->*members), ...);
    return !leaves_some(some);
  };
  if (excludes(&capture_constraint::light)) return "light";
  if (excludes(&capture_constraint::viewer)) return "viewer";
  if (excludes(&capture_constraint::smallest_separation)) return "separation";
  if (excludes(&capture_constraint::light_step, &capture_constraint::light_tolerance)) return "light_step";
  if (excludes(&capture_constraint::forbidden)) return "forbid";
  if (excludes(&capture_constraint::plane_tolerance)) return "in_plane";
  if (excludes(&capture_constraint::pairs)) return "pair";
  return {};
}

}  // namespace gonio::design
