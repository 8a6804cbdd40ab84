#pragma once
/// Bodies of shape/surface_distance.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/shape/surface_distance.hpp>
#include <gonio/shape/surface_index.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace gonio::shape {

GONIO_INLINE Eigen::VectorXd signed_distances(const surface_index& surface, const point_columns& points,
                                              thread_count threads) {
  Eigen::VectorXd distances(points.cols());
  for_each_block(
      points.cols(), 256,
      [&](block some) {
        for (Eigen::Index i = some.begin; i < some.end; ++i) distances[i] = surface.signed_distance(points.col(i));
      },
      threads);
  return distances;
}

GONIO_INLINE surface_distance surface_distance::of(const Eigen::VectorXd& signed_distances) {
  if (signed_distances.size() == 0) refuse("the mean distance to a surface needs at least one point");
  surface_distance found;
  for (const double distance : signed_distances) {
    if (!std::isfinite(distance)) refuse("a distance to a surface is not finite");
    found.largest = std::max(found.largest, std::abs(distance));
  }
  if (found.largest == 0.0) return found;
  const auto count = static_cast<double>(signed_distances.size());
  double squares = 0.0;  // relative to the largest, so that they do not overflow
  for (const double distance : signed_distances) {
    const double share = distance / found.largest;
    found.signed_mean += distance;
    found.absolute_mean += std::abs(distance);
    squares += share * share;
  }
  found.signed_mean /= count;
  found.absolute_mean /= count;
  found.root_mean_square = found.largest * std::sqrt(squares / count);
  return found;
}

GONIO_INLINE surface_distance distance_to(const surface_index& surface, const point_columns& points,
                                          thread_count threads) {
  return surface_distance::of(signed_distances(surface, points, threads));
}

}  // namespace gonio::shape
