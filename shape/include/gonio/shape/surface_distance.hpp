#pragma once
/// Signed distances of points from a surface, the error measure of "Anatomically correct surface recovery" (Nielsen,
/// doctoral thesis, DTU 2016, contribution C.V, section 4) for recovered vertices.

#include <gonio/shape/surface_index.hpp>

#include <Eigen/Core>

namespace gonio::shape {

/// Returns `surface_index::signed_distance` of each column of `points`, in their order. Throws gonio::error if a point
/// is not finite.
[[nodiscard]] Eigen::VectorXd signed_distances(const surface_index& surface, const point_columns& points,
                                               thread_count threads = {});

/// Statistics of signed distances, in the unit of the mesh. The paper's table has the signed means.
struct surface_distance {
  double signed_mean = 0.0;       ///< positive if the points are mostly outside
  double absolute_mean = 0.0;     ///< of the magnitudes
  double root_mean_square = 0.0;  ///< not below `absolute_mean`
  double largest = 0.0;           ///< magnitude

  /// Throws gonio::error if there is no distance or one is not finite.
  [[nodiscard]] static surface_distance of(const Eigen::VectorXd& signed_distances);
};

/// Returns the statistics of the points' distances from a surface. Select some points, such as recovered ones, with
/// `points(Eigen::all, vertices)`. Distances of the surface's vertices from the points' own mesh would differ. Throws
/// gonio::error if there is no point or one is not finite.
[[nodiscard]] surface_distance distance_to(const surface_index& surface, const point_columns& points,
                                           thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/surface_distance.ipp>
#endif
