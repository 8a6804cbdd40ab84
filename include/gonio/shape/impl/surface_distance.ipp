#pragma once
/// Bodies of shape/surface_distance.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/shape/surface_distance.hpp>
#include <gonio/shape/surface_index.hpp>

#include <cmath>
#include <string>

namespace gonio {

GONIO_INLINE Eigen::VectorXd signed_distances(const surface_index& surface, const point_columns& points,
                                              thread_count threads) {
  Eigen::VectorXd distances(points.cols());
  for_each_block(
      static_cast<std::size_t>(points.cols()), 256,
      [&](block some) {
        for (auto i = static_cast<Eigen::Index>(some.begin); i < static_cast<Eigen::Index>(some.end); ++i)
          distances[i] = surface.signed_distance(points.col(i));
      },
      threads);
  return distances;
}

GONIO_INLINE surface_distance surface_distance::of(const Eigen::VectorXd& signed_distances) {
  if (signed_distances.size() == 0) throw error("the distance of no points to a surface has no mean");
  if (!signed_distances.allFinite()) throw error("a distance to a surface is not finite");
  const double largest = signed_distances.cwiseAbs().maxCoeff(), count = static_cast<double>(signed_distances.size());
  return {signed_distances.mean(), signed_distances.cwiseAbs().mean(), signed_distances.stableNorm() / std::sqrt(count),
          largest};
}

}  // namespace gonio
