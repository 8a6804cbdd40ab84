#pragma once
/// The limits of an apparatus: lights on an arc, arms that must keep away from each other and from the horizon.

#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace gonio::design {

/// A range of polar angles in radians. Both ends are included, within 1e-9 for rounding.
struct polar_range {
  double smallest = 0.0;
  double largest = std::numbers::pi / 2.0;

  [[nodiscard]] bool contains(double theta) const noexcept {
    return theta >= smallest - 1e-9 && theta <= largest + 1e-9;
  }
};

/// A combination that cannot be reached: light and viewer each in their range at the same time.
struct forbidden_zone {
  polar_range light, viewer;
};

/// The pairs of directions that an apparatus can measure. All angles are in radians. The default allows every pair. For
/// an image, the rules apply to the directions at its centre.
struct capture_constraint {
  polar_range light, viewer;              ///< the polar angles that light and viewer can reach
  double smallest_separation = 0.0;       ///< angle between light and viewer, below which one occludes the other
  double light_step = 0.0;                ///< if above 0, the light can only be at multiples of this polar angle
  double light_tolerance = radians(0.5);  ///< largest distance of the light from a multiple of `light_step`
  std::vector<forbidden_zone> forbidden;
  /// If set, the largest angle between the viewer and the plane that contains light and normal.
  std::optional<double> plane_tolerance;
  /// If not empty, the only pairs that the instrument can measure, because its light and viewers are fixed. A pair
  /// matches within half a degree.
  std::vector<direction_pair> pairs;

  [[nodiscard]] bool is_none() const noexcept;

  [[nodiscard]] bool operator()(const direction_pair& pair) const;

  /// Returns a pair with these angles that the apparatus can reach: as given, or by reciprocity with light and viewer
  /// exchanged. Returns nothing if it can reach neither. If `plane_tolerance` is set, phi_d becomes 0 first, which
  /// moves the pair into the plane of incidence.
  [[nodiscard]] std::optional<direction_pair> pose_of(const half_difference& angles) const;

  /// Returns the position of the first of `pairs` that matches a pair. Pairs also match with light and viewer
  /// exchanged, turned about the normal, or mirrored.
  [[nodiscard]] std::optional<std::size_t> fixed_pair(const direction_pair& pair) const;

  /// Applies the rules one by one, in the order of the members of this class, each in addition to all before. Returns
  /// the name of the first rule with which `leaves_some` returns false; empty if there is none.
  [[nodiscard]] std::string excluding_rule(const std::function<bool(const capture_constraint&)>& leaves_some) const;
};

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/capture_constraint.ipp>
#endif
