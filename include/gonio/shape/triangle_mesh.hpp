#pragma once
/// Triangulated surfaces: scans, and the template that all shapes of a model share.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <utility>

namespace gonio {

/// A point of space for each column, in any unit of length; the published thresholds are for millimetres.
using point_columns = Eigen::Matrix3Xd;

/// The three vertices of a triangle for each column, anticlockwise as seen from outside.
using triangle_columns = Eigen::Matrix3Xi;

/// A surface in space. See `mesh_topology` for what is asked of one.
struct triangle_mesh {
  point_columns vertices;
  triangle_columns triangles;

  /// The three corners of a triangle, one for each column.
  [[nodiscard]] Eigen::Matrix3d corners(Eigen::Index triangle) const {
    Eigen::Matrix3d all;
    for (Eigen::Index corner = 0; corner < 3; ++corner) all.col(corner) = vertices.col(triangles(corner, triangle));
    return all;
  }
};

/// Twice the area of each triangle times its outward normal: 3 x triangles. O(triangles).
[[nodiscard]] inline point_columns area_normals(const triangle_mesh& mesh) {
  point_columns normals(3, mesh.triangles.cols());
  for (Eigen::Index t = 0; t < normals.cols(); ++t) {
    const Eigen::Matrix3d corners = mesh.corners(t);
    const Eigen::Vector3d first = corners.col(1) - corners.col(0), second = corners.col(2) - corners.col(0);
    normals.col(t) = first.cross(second);
  }
  return normals;
}

/// Each column made 1 long; zero stays zero.
[[nodiscard]] inline point_columns unit_columns(point_columns vectors) {
  for (auto vector : vectors.colwise()) {
    const double length = vector.norm();
    if (length > 0.0) vector /= length;
  }
  return vectors;
}

/// Outward unit normals at the vertices, the mean of the triangles around them by area; zero where all of these have
/// none. O(triangles).
[[nodiscard]] inline point_columns vertex_normals(const triangle_mesh& mesh) {
  const point_columns areas = area_normals(mesh);
  point_columns sums = point_columns::Zero(3, mesh.vertices.cols());
  for (Eigen::Index t = 0; t < areas.cols(); ++t)
    for (Eigen::Index corner = 0; corner < 3; ++corner) sums.col(mesh.triangles(corner, t)) += areas.col(t);
  return unit_columns(std::move(sums));
}

}  // namespace gonio
