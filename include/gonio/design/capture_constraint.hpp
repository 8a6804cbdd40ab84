#pragma once
/// What an apparatus cannot do: lights on an arc, arms that must not come too close to one another or to the horizon.

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

/// A range of polar angles, both ends included, in radians; what is rounded of a direction counts as the end.
struct polar_range {
  double smallest = 0.0;
  double largest = std::numbers::pi / 2.0;

  [[nodiscard]] bool contains(double theta) const noexcept {
    return theta >= smallest - 1e-9 && theta <= largest + 1e-9;
  }
};

/// Settings that cannot be reached: the light in one range while the viewer is in the other.
struct forbidden_zone {
  polar_range light, viewer;
};

/// Which pairs of directions an apparatus can measure. All angles in radians; by default it can measure all. Of a
/// image, the directions are those of its centre.
struct capture_constraint {
  polar_range light, viewer;              ///< where light and viewer can be
  double smallest_separation = 0.0;       ///< between light and viewer, which hide one another
  double light_step = 0.0;                ///< lights stand at multiples of this polar angle; 0: anywhere
  double light_tolerance = radians(0.5);  ///< by how much one may miss the light that is meant
  std::vector<forbidden_zone> forbidden;
  /// The viewer stands in the plane of light and normal, or misses it by at most so much.
  std::optional<double> plane_tolerance;
  /// An instrument whose light and viewers are fixed has these pairs alone, each met to half a degree; any pair if
  /// there is none here.
  std::vector<direction_pair> pairs;

  [[nodiscard]] bool is_none() const noexcept;

  [[nodiscard]] bool operator()(const direction_pair& pair) const;

  /// Light and viewer with these angles between them where they can be: as the angles have them, or by reciprocity in
  /// each other's place; nothing if neither can be. Where only the plane of incidence is allowed, those next to it are
  /// moved into it.
  [[nodiscard]] std::optional<direction_pair> pose_of(const half_difference& angles) const;

  /// The position in `pairs` of the one that is met by a pair, light and viewer in either place, whatever its azimuth.
  [[nodiscard]] std::optional<std::size_t> fixed_pair(const direction_pair& pair) const;

  /// The name of the first rule, of those above in their order, that leaves nothing to measure together with those
  /// before it, by what `leaves_some` says of constraints; empty if all of them leave something.
  [[nodiscard]] std::string excluding_rule(const std::function<bool(const capture_constraint&)>& leaves_some) const;
};

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/capture_constraint.ipp>
#endif
