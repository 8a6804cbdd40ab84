#pragma once
/// Finds the closest point of a triangulated surface, its intersection with a line, and the side of a point. Ericson,
/// "Real-Time Collision Detection" (2005), sections 5.1.5, 5.3.3, 5.3.6 and 6.1; signs by Baerentzen and Aanaes,
/// "Signed distance computation using the angle weighted pseudonormal" (IEEE TVCG 11(3), 2005,
/// doi:10.1109/TVCG.2005.49).

#include <gonio/core/parallel.hpp>
#include <gonio/shape/mesh_topology.hpp>

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <vector>

namespace gonio::shape {

/// A point of a surface found by a query.
struct surface_point {
  Eigen::Vector3d position;
  Eigen::Index triangle = 0;
  Eigen::Vector3d barycentric;  ///< of the triangle's corners; they sum to 1
  bool on_border = false;       ///< on an edge of a single triangle, where the rest of the surface may be missing
  double distance = 0.0;        ///< to the query point, not negative
};

/// A surface with a search structure for queries. Copies are cheap and share it. All queries may run concurrently.
///
/// The triangles are in a tree of boxes. A k-d tree of their centroids (nanoflann) was as fast for points near an even
/// mesh, but eight times slower if some triangles are eight times as long, and does not support lines.
class surface_index {
 public:
  /// O(n log n) for n triangles. Throws gonio::error as `mesh_topology` does.
  explicit surface_index(triangle_mesh mesh);

  [[nodiscard]] const triangle_mesh& mesh() const noexcept;
  [[nodiscard]] const mesh_topology& topology() const noexcept;

  /// Returns the closest point of the surface, up to rounding. If several triangles are equally far, the point is on
  /// the one with the lowest number. About O(log n) near the surface. Throws gonio::error if the point or the squared
  /// distance is not finite.
  [[nodiscard]] surface_point closest(const Eigen::Vector3d& point) const;

  /// Returns the intersection nearest to `origin` with the line through it, in both directions. It is at most `reach`
  /// away, in the unit of the mesh, whatever the length of `line`. Triangles seen edge-on are not hit. Throws
  /// gonio::error unless all values are finite (`reach` may be infinite), the direction is not zero and `reach` is not
  /// negative.
  [[nodiscard]] std::optional<surface_point> along(const Eigen::Vector3d& origin, const Eigen::Vector3d& line,
                                                   double reach) const;

  /// Returns the outward normal that determines signs: inside a triangle, its normal; on an edge, the mean normal of
  /// its triangles; at a vertex, the mean normal of its triangles, weighted by their angles there. It has length 1, or
  /// is zero if none of these triangles has an area.
  [[nodiscard]] Eigen::Vector3d pseudonormal(const surface_point& point) const;

  /// Returns the distance to the surface, positive outside. Baerentzen and Aanaes define the sign, and prove it for
  /// closed surfaces. Beyond a border, the sign refers to the continued surface. Throws gonio::error if the point is
  /// not finite.
  [[nodiscard]] double signed_distance(const Eigen::Vector3d& point) const;

 private:
  struct built_surface;  // the mesh and the search structures

  std::shared_ptr<const built_surface> surface_;
};

/// Returns `closest` for each column of `points`, in their order. Throws gonio::error if a point is not finite.
[[nodiscard]] std::vector<surface_point> closest_points(const surface_index& surface, const point_columns& points,
                                                        thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/surface_index.ipp>
#endif
