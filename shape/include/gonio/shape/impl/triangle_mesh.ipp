#pragma once
/// Bodies of shape/triangle_mesh.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <span>
#include <utility>

namespace gonio::shape {

GONIO_INLINE Eigen::Matrix3d triangle_mesh::corners(Eigen::Index triangle) const {
  Eigen::Matrix3d all;
  for (Eigen::Index corner = 0; corner < 3; ++corner) all.col(corner) = vertices.col(triangles(corner, triangle));
  return all;
}

GONIO_INLINE double triangle_mesh::angle(Eigen::Index triangle, Eigen::Index corner) const {
  const auto position = [&](Eigen::Index of) -> Eigen::Vector3d { return vertices.col(triangles(of % 3, triangle)); };
  const Eigen::Vector3d here = position(corner), next = position(corner + 1) - here, last = position(corner + 2) - here;
  return std::atan2(next.cross(last).norm(), next.dot(last));
}

GONIO_INLINE point_columns area_normals(const triangle_mesh& mesh) {
  point_columns normals(3, mesh.triangles.cols());
  for (Eigen::Index t = 0; t < normals.cols(); ++t) {
    const auto corner = [&](Eigen::Index number) -> Eigen::Vector3d {
      return mesh.vertices.col(mesh.triangles(number, t));
    };
    const Eigen::Vector3d origin = corner(0), first = corner(1) - origin, second = corner(2) - origin;
    normals.col(t) = first.cross(second);
  }
  return normals;
}

GONIO_INLINE Eigen::Vector3d unit_vector(const Eigen::Vector3d& vector) {
  const double largest = vector.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) return vector;
  const Eigen::Vector3d scaled = vector / largest;
  return scaled / scaled.norm();
}

GONIO_INLINE point_columns unit_columns(point_columns vectors) {
  for (auto vector : vectors.colwise()) {
    const double length = vector.norm();
    if (length > 0.0) vector /= length;
  }
  return vectors;
}

GONIO_INLINE Eigen::Vector3d centroid_of(const point_columns& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index v = 0; v < points.cols(); ++v) sum += points.col(v);
  return sum / static_cast<double>(points.cols());
}

GONIO_INLINE point_columns chosen_columns(const point_columns& all, std::span<const Eigen::Index> numbers) {
  point_columns chosen(3, std::ssize(numbers));
  for (Eigen::Index i = 0; i < std::ssize(numbers); ++i) chosen.col(i) = all.col(numbers[i]);
  return chosen;
}

GONIO_INLINE point_columns vertex_normals(const triangle_mesh& mesh) {
  const point_columns areas = area_normals(mesh);
  point_columns sums = point_columns::Zero(3, mesh.vertices.cols());
  for (Eigen::Index t = 0; t < areas.cols(); ++t)
    for (Eigen::Index corner = 0; corner < 3; ++corner) sums.col(mesh.triangles(corner, t)) += areas.col(t);
  return unit_columns(std::move(sums));
}

}  // namespace gonio::shape
