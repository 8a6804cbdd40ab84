#pragma once
/// Where a triangulated surface is closest to a point, where a line meets it, and on which side of it a point is.
/// Ericson, "Real-Time Collision Detection" (2005), sections 5.1.5, 5.3.3, 5.3.6 and 6.1; signs by Baerentzen and
/// Aanaes, "Signed distance computation using the angle weighted pseudonormal" (IEEE TVCG 11(3), 2005,
/// doi:10.1109/TVCG.2005.49).

#include <gonio/core/parallel.hpp>
#include <gonio/shape/mesh_topology.hpp>

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <vector>

namespace gonio::shape {

/// A place on a surface that a query found.
struct surface_point {
  Eigen::Vector3d position;
  Eigen::Index triangle = 0;
  Eigen::Vector3d barycentric;  ///< shares of the triangle's corners, which sum to 1
  bool on_border = false;       ///< on an edge of a single triangle: the surface may go on, but is missing
  double distance = 0.0;        ///< to where the query started, not negative
};

/// A surface to ask about places. Copies are cheap: they share what was built. All queries may run at the same time.
///
/// The triangles are in a tree of boxes of our own. A tree of their centroids (nanoflann) has to search as far beyond
/// the best triangle as the largest one reaches, and does not help with lines: it was measured as fast for points near
/// an even mesh, and eight times slower where a part of the triangles is eight times as long.
class surface_index {
 public:
  /// O(n log n) for n triangles. Throws gonio::error as `mesh_topology` does.
  explicit surface_index(triangle_mesh mesh);

  [[nodiscard]] const triangle_mesh& mesh() const noexcept;
  [[nodiscard]] const mesh_topology& topology() const noexcept;

  /// The closest point of the surface, to rounding; of triangles at the same distance that of the lowest number. About
  /// O(log n) near the surface. Throws gonio::error if the point is not finite or the
  /// square of the distance is not.
  [[nodiscard]] surface_point closest(const Eigen::Vector3d& point) const;

  /// Where the line through `origin` meets the surface nearest to it, both ways and at most `reach` away, in the unit
  /// of the mesh whatever the length of `line`. Triangles seen edge-on are not met. Throws gonio::error unless all
  /// is finite (`reach` may be infinite), the direction is not zero and `reach` is not negative.
  [[nodiscard]] std::optional<surface_point> along(const Eigen::Vector3d& origin, const Eigen::Vector3d& line,
                                                   double reach) const;

  /// The outward normal by which signs are decided: the triangle's; on an edge the mean of its triangles'; at a vertex
  /// the mean of its triangles' by their angles there. Of length 1, or zero if none of these triangles has an area.
  [[nodiscard]] Eigen::Vector3d pseudonormal(const surface_point& place) const;

  /// The distance to the surface, positive on the outside. The sign is that of Baerentzen and Aanaes, who prove it for
  /// closed surfaces; interpolated vertex normals have it wrong near sharp edges. Beyond a border it tells the sides of
  /// the surface as continued there. Throws gonio::error if the point is not finite.
  [[nodiscard]] double signed_distance(const Eigen::Vector3d& point) const;

 private:
  struct built_surface;  // the mesh with all that queries need

  std::shared_ptr<const built_surface> surface_;
};

/// `closest` of each column of `points`, in their order. Throws gonio::error if a point is not finite.
[[nodiscard]] std::vector<surface_point> closest_points(const surface_index& surface, const point_columns& points,
                                                        thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/surface_index.ipp>
#endif
