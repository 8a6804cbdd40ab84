#pragma once
/// Bodies of table/aperture.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/table/aperture.hpp>

#include <cmath>
#include <numbers>
#include <vector>

namespace gonio {

GONIO_INLINE double half_angle_of(double solid_angle) {
  const double half_angle = std::acos(1.0 - solid_angle / (2.0 * std::numbers::pi));
  if (!(solid_angle >= 0.0 && half_angle <= largest_half_angle))
    refuse({"a solid angle of ", solid_angle, " sr, expected from 0 to 1.84 (a half angle of 45 degrees)"});
  return half_angle;
}

GONIO_INLINE std::vector<direction_pair> pairs_within(const direction_pair& axes, const aperture& cones, int count) {
  // Rings of equal solid angle, each rotated by a golden section of a turn from the one before.
  constexpr double golden_turn = 2.0 * std::numbers::pi * (2.0 - std::numbers::phi);
  const auto within = [count](const direction& axis, double half_angle, int ring, double first_turn) {
    const double cosine = 1.0 - (1.0 - std::cos(half_angle)) * (ring + 0.5) / count;
    return turned(axis, std::acos(cosine), first_turn + ring * golden_turn);
  };
  const auto backwards = [count](int number) {
    int read = 0;
    for (int bit = 1; bit < count; bit *= 2, number /= 2) read = 2 * read + number % 2;
    return read;
  };
  std::vector<direction_pair> pairs;
  for (int i = 0; i < count; ++i) {
    const direction_pair pair{within(axes.wi, cones.source, backwards(i), 0.0),
                              within(axes.wo, cones.receiver, i, 1.0)};
    if (pair.wi.z() > 0.0 && pair.wo.z() > 0.0) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace gonio
