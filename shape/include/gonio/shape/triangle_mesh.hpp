#pragma once
/// Triangulated surfaces: scans, and the common template of a model's shapes.

#include <Eigen/Core>

#include <span>

namespace gonio::shape {

/// One point per column, in any unit of length. The published thresholds are in millimetres.
using point_columns = Eigen::Matrix3Xd;

/// The three vertices of a triangle per column, anticlockwise as seen from outside.
using triangle_columns = Eigen::Matrix3Xi;

/// A surface in space. `mesh_topology` lists the requirements.
struct triangle_mesh {
  point_columns vertices;
  triangle_columns triangles;

  /// Returns the three corners of a triangle, one per column.
  [[nodiscard]] Eigen::Matrix3d corners(Eigen::Index triangle) const;

  /// Returns the angle of a triangle at its corner 0, 1 or 2.
  [[nodiscard]] double angle(Eigen::Index triangle, Eigen::Index corner) const;
};

/// Returns twice the area of each triangle times its outward normal: 3 x triangles. O(triangles).
[[nodiscard]] point_columns area_normals(const triangle_mesh& mesh);

/// Returns a vector scaled to length 1, even if its squared length would overflow or underflow; zero stays zero.
[[nodiscard]] Eigen::Vector3d unit_vector(const Eigen::Vector3d& vector);

/// Returns each column scaled to length 1; zero stays zero.
[[nodiscard]] point_columns unit_columns(point_columns vectors);

/// Returns the mean of the points. There must be at least one.
[[nodiscard]] Eigen::Vector3d centroid_of(const point_columns& points);

/// Returns the columns with these numbers, in their order.
[[nodiscard]] point_columns chosen_columns(const point_columns& all, std::span<const Eigen::Index> numbers);

/// Returns outward unit normals at the vertices: the area-weighted mean normal of the triangles around them; zero if
/// none of these has an area. O(triangles).
[[nodiscard]] point_columns vertex_normals(const triangle_mesh& mesh);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/triangle_mesh.ipp>
#endif
