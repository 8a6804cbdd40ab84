#pragma once
/// Bodies of shape/mesh_surface.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/core/pinhole_camera.hpp>
#include <gonio/shape/mesh_surface.hpp>
#include <gonio/shape/triangle_mesh.hpp>
#include <gonio/table/surface_image.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

namespace gonio::shape::detail {

GONIO_INLINE triangle_tree::triangle_tree(const triangle_mesh& mesh)
    : mesh_(mesh), centres_(3, mesh.triangles.cols()), order_(static_cast<std::size_t>(mesh.triangles.cols())) {
  for (Eigen::Index t = 0; t < centres_.cols(); ++t) centres_.col(t) = mesh.corners(t).rowwise().mean();
  std::iota(order_.begin(), order_.end(), Eigen::Index{0});
  add_node(0, std::ssize(order_));
}

GONIO_INLINE void triangle_tree::add_node(Eigen::Index first, Eigen::Index count) {
  // Enclose the triangles.
  box_node node{Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()),
                Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity()), first, count};
  for (Eigen::Index i = first; i < first + count; ++i) {
    const Eigen::Matrix3d corners = mesh_.corners(order_[i]);
    node.low = node.low.cwiseMin(corners.rowwise().minCoeff());
    node.high = node.high.cwiseMax(corners.rowwise().maxCoeff());
  }
  const auto number = std::ssize(nodes_);
  nodes_.push_back(node);
  constexpr Eigen::Index leaf = 4;
  if (count <= leaf) return;
  // Halve the node's triangles along the longest side of its box.
  Eigen::Index axis = 0;
  static_cast<void>((node.high - node.low).maxCoeff(&axis));
  const auto begin = order_.begin() + first, middle = begin + count / 2;
  std::nth_element(begin, middle, begin + count,
                   [&](Eigen::Index a, Eigen::Index b) { return centres_(axis, a) < centres_(axis, b); });
  nodes_[number].count = 0;
  add_node(first, count / 2);
  nodes_[number].second_child = std::ssize(nodes_);
  add_node(first + count / 2, count - count / 2);
}

/// Returns whether a ray meets a box before a distance.
[[nodiscard]] GONIO_INLINE bool meets_box(const ray& line, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                                          double before) {
  double enter = 0.0, leave = before;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (line.towards[axis] == 0.0) {
      if (line.origin[axis] < low[axis] || line.origin[axis] > high[axis]) return false;
      continue;
    }
    const double a = (low[axis] - line.origin[axis]) / line.towards[axis],
                 b = (high[axis] - line.origin[axis]) / line.towards[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  // A small tolerance, because a flat box has no depth.
  return enter <= leave + 1e-9 * (1.0 + std::abs(enter));
}

/// T. Moeller and B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997
/// (doi:10.1080/10867651.1997.10487468).
GONIO_INLINE void triangle_tree::meet(const ray& line, Eigen::Index triangle, mesh_hit& best) const {
  const Eigen::Matrix3d corners = mesh_.corners(triangle);
  const Eigen::Vector3d a = corners.col(1) - corners.col(0), b = corners.col(2) - corners.col(0);
  const Eigen::Vector3d across = line.towards.cross(b);
  const double determinant = a.dot(across);
  if (determinant == 0.0) return;  // seen edge-on
  const Eigen::Vector3d from = line.origin - corners.col(0), along = from.cross(a);
  const double u = from.dot(across) / determinant, v = line.towards.dot(along) / determinant;
  constexpr double border = -1e-12;
  if (!(u >= border && v >= border && u + v <= 1.0 - border)) return;
  const double distance = b.dot(along) / determinant;
  if (!(distance > 0.0)) return;
  if (distance < best.distance || (distance == best.distance && triangle < best.triangle))
    best = {distance, triangle, {1.0 - u - v, u, v}};
}

GONIO_INLINE mesh_hit triangle_tree::nearest(const ray& line) const {
  mesh_hit best;
  std::vector<Eigen::Index> open{0};
  while (!open.empty()) {
    const Eigen::Index number = open.back();
    open.pop_back();
    const box_node& node = nodes_[number];
    if (!meets_box(line, node.low, node.high, best.distance)) continue;
    for (Eigen::Index i = node.first; i < node.first + node.count; ++i) meet(line, order_[i], best);
    if (node.count > 0) continue;
    open.push_back(node.second_child);
    open.push_back(number + 1);
  }
  return best;
}

GONIO_INLINE void require_visible(const triangle_mesh& mesh) {
  if (mesh.triangles.cols() == 0) refuse("a mesh without triangles cannot be seen");
  if (mesh.triangles.minCoeff() < 0 || mesh.triangles.maxCoeff() >= mesh.vertices.cols())
    refuse({"a triangle of the mesh names a vertex that does not exist, expected less than ", mesh.vertices.cols()});
  if (!mesh.vertices.allFinite()) refuse("a vertex of the mesh is not finite");
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE surface_image surface_of(const triangle_mesh& mesh, const lens_camera& camera) {
  detail::require_visible(mesh);
  const detail::triangle_tree tree(mesh);
  const point_columns normals = vertex_normals(mesh);
  const camera_intrinsics& size = camera.intrinsics();
  surface_image seen = surface_image::nothing(size.rows, size.columns);
  for (std::size_t row = 0; row < size.rows; ++row)
    for (std::size_t column = 0; column < size.columns; ++column) {
      const ray line = camera.ray_through(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
      const detail::mesh_hit hit = tree.nearest(line);
      if (hit.triangle < 0) continue;
      const Eigen::Matrix3d corners = mesh.corners(hit.triangle);
      const Eigen::Vector3d outwards = (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
      if (!(outwards.dot(line.towards) < 0.0)) continue;
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
      for (Eigen::Index corner = 0; corner < 3; ++corner)
        normal += hit.shares[corner] * normals.col(mesh.triangles(corner, hit.triangle));
      const Eigen::Index pixel = seen.pixel(row, column);
      seen.positions.col(pixel) = line.origin + hit.distance * line.towards;
      seen.normals.col(pixel) = unit_vector(normal);
    }
  return seen;
}

}  // namespace gonio::shape
