#pragma once
/// Triangulated surfaces: scans, and the template that all shapes of a model share.

#include <Eigen/Core>

#include <span>

namespace gonio::shape {

/// A point of space for each column, in any unit of length; the published thresholds are for millimetres.
using point_columns = Eigen::Matrix3Xd;

/// The three vertices of a triangle for each column, anticlockwise as seen from outside.
using triangle_columns = Eigen::Matrix3Xi;

/// A surface in space. See `mesh_topology` for what is asked of one.
struct triangle_mesh {
  point_columns vertices;
  triangle_columns triangles;

  /// The three corners of a triangle, one for each column.
  [[nodiscard]] Eigen::Matrix3d corners(Eigen::Index triangle) const;

  /// The angle of a triangle at its corner 0, 1 or 2.
  [[nodiscard]] double angle(Eigen::Index triangle, Eigen::Index corner) const;
};

/// Twice the area of each triangle times its outward normal: 3 x triangles. O(triangles).
[[nodiscard]] point_columns area_normals(const triangle_mesh& mesh);

/// A vector made 1 long, also where the square of its length is too large or too small for a number; zero stays zero.
[[nodiscard]] Eigen::Vector3d unit_vector(const Eigen::Vector3d& vector);

/// Each column made 1 long; zero stays zero.
[[nodiscard]] point_columns unit_columns(point_columns vectors);

/// The mean of the points, of which there is one.
[[nodiscard]] Eigen::Vector3d centroid_of(const point_columns& points);

/// Some of the columns, in the order given.
[[nodiscard]] point_columns chosen_columns(const point_columns& all, std::span<const Eigen::Index> numbers);

/// Outward unit normals at the vertices, the mean of the triangles around them by area; zero where all of these have
/// none. O(triangles).
[[nodiscard]] point_columns vertex_normals(const triangle_mesh& mesh);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/triangle_mesh.ipp>
#endif
