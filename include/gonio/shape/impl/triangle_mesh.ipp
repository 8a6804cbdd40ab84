#pragma once
/// Bodies of shape/triangle_mesh.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <utility>

namespace gonio {

GONIO_INLINE Eigen::Matrix3d triangle_mesh::corners(Eigen::Index triangle) const {
  Eigen::Matrix3d all;
  for (Eigen::Index corner = 0; corner < 3; ++corner) all.col(corner) = vertices.col(triangles(corner, triangle));
  return all;
}

GONIO_INLINE point_columns area_normals(const triangle_mesh& mesh) {
  point_columns normals(3, mesh.triangles.cols());
  for (Eigen::Index t = 0; t < normals.cols(); ++t) {
    const Eigen::Matrix3d corners = mesh.corners(t);
    const Eigen::Vector3d first = corners.col(1) - corners.col(0), second = corners.col(2) - corners.col(0);
    normals.col(t) = first.cross(second);
  }
  return normals;
}

GONIO_INLINE point_columns unit_columns(point_columns vectors) {
  for (auto vector : vectors.colwise()) {
    const double length = vector.norm();
    if (length > 0.0) vector /= length;
  }
  return vectors;
}

GONIO_INLINE point_columns vertex_normals(const triangle_mesh& mesh) {
  const point_columns areas = area_normals(mesh);
  point_columns sums = point_columns::Zero(3, mesh.vertices.cols());
  for (Eigen::Index t = 0; t < areas.cols(); ++t)
    for (Eigen::Index corner = 0; corner < 3; ++corner) sums.col(mesh.triangles(corner, t)) += areas.col(t);
  return unit_columns(std::move(sums));
}

}  // namespace gonio
