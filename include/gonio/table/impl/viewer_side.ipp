#pragma once
/// Bodies of table/viewer_side.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/table/viewer_side.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace gonio {

GONIO_INLINE double brightness_towards_light(const sample_set& samples) {
  constexpr double least_incidence = 10.0, reach = 5.0;  // degrees
  const double in_plane = std::cos(radians(reach));
  struct sides {
    std::optional<double> light, mirror, elsewhere;  ///< the value of the brightest sample there
  };
  std::map<long, sides> incidences;
  double largest = 0.0;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    const auto& [wi, wo] = samples.directions(i).pair();
    const double theta_i = degrees(polar_angle(wi)), theta_o = degrees(polar_angle(wo));
    if (theta_i < least_incidence) continue;
    const double product = wi.x() * wo.x() + wi.y() * wo.y();
    if (std::abs(product) < in_plane * std::hypot(wi.x(), wi.y()) * std::hypot(wo.x(), wo.y())) continue;
    const double value = std::ranges::max(samples.values(i));
    largest = std::max(largest, value);
    sides& both = incidences[std::lround(2.0 * theta_i)];
    const bool is_towards_light = product > 0.0, is_near = std::abs(theta_o - theta_i) <= reach;
    if (is_towards_light && !is_near) continue;
    std::optional<double>& side = is_towards_light ? both.light : is_near ? both.mirror : both.elsewhere;
    side = std::max(side.value_or(value), value);
  }
  std::vector<double> ratios;
  const double floor = 1e-3 * largest;  // a receiver that hides the lamp reads almost 0
  for (const auto& [angle, both] : incidences)
    if (const auto other = both.mirror ? both.mirror : both.elsewhere; both.light && other && floor > 0.0)
      ratios.push_back(*both.light / std::max(*other, floor));
  return ratios.empty() ? 0.0 : median(ratios);
}

GONIO_INLINE sample_set with_viewers_turned(const sample_set& samples) {
  sample_set turned(samples.channels());
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    const auto& [wi, wo] = samples.directions(i).pair();
    turned.add(direction_pair{wi, {-wo.x(), -wo.y(), wo.z()}}, samples.values(i), samples.weight(i),
               samples.aperture(i));
  }
  return turned;
}

}  // namespace gonio
