#pragma once
/// How far points are from a surface, by the sides of its normals: how "Anatomically correct surface recovery"
/// (Nielsen, doctoral thesis, DTU 2016, contribution C.V, section 4) judges recovered vertices by the original surface.

#include <gonio/shape/surface_index.hpp>

#include <cmath>
#include <string>

namespace gonio {

/// `surface_index::signed_distance` of each column of `points`, in their order. Throws gonio::error if a point is not
/// finite.
[[nodiscard]] inline Eigen::VectorXd signed_distances(const surface_index& surface, const point_columns& points,
                                                      thread_count threads = {}) {
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

/// What is told of signed distances, in the unit of the mesh. The paper's table has the signed means.
struct surface_distance {
  double signed_mean = 0.0;       ///< positive if the points are rather outside
  double absolute_mean = 0.0;     ///< of the magnitudes
  double root_mean_square = 0.0;  ///< not below `absolute_mean`
  double largest = 0.0;           ///< magnitude

  /// Throws gonio::error if there is no distance or one is not finite.
  [[nodiscard]] static surface_distance of(const Eigen::VectorXd& signed_distances) {
    if (signed_distances.size() == 0) throw error("the distance of no points to a surface has no mean");
    if (!signed_distances.allFinite()) throw error("a distance to a surface is not finite");
    const double largest = signed_distances.cwiseAbs().maxCoeff(), count = static_cast<double>(signed_distances.size());
    return {signed_distances.mean(), signed_distances.cwiseAbs().mean(),
            signed_distances.stableNorm() / std::sqrt(count), largest};
  }
};

/// How far points are from a surface; select some, as the recovered ones, with `points(Eigen::all, vertices)`. The
/// other way, from a surface's vertices to the points' mesh, is another distance. Throws gonio::error if there is no
/// point or one is not finite.
[[nodiscard]] inline surface_distance distance_to(const surface_index& surface, const point_columns& points,
                                                  thread_count threads = {}) {
  return surface_distance::of(signed_distances(surface, points, threads));
}

}  // namespace gonio
