#pragma once
/// Bodies of shape/correspondence.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/correspondence.hpp>
#include <gonio/shape/fitted_shape.hpp>
#include <gonio/shape/surface_index.hpp>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace gonio::shape {

GONIO_INLINE surface_point posed_scan::closest(const Eigen::Vector3d& point) const {
  return in_model_space(surface.closest(pose.inverse()(point)));
}

GONIO_INLINE Eigen::Vector3d posed_scan::normal(const surface_point& point) const {
  return pose.rotation * surface.pseudonormal(point);
}

GONIO_INLINE std::optional<surface_point> posed_scan::along(const Eigen::Vector3d& point, const Eigen::Vector3d& line,
                                                            double reach) const {
  const similarity_transform back = pose.inverse();
  const auto found = surface.along(back(point), back.rotation * line, reach * back.scale);
  if (!found) return {};
  return in_model_space(*found);
}

GONIO_INLINE double posed_scan::weight_at(const surface_point& point) const {
  if (weights.size() == 0) return 1.0;
  double sum = 0.0;
  for (Eigen::Index corner = 0; corner < 3; ++corner)
    sum += point.barycentric[corner] * weights[surface.mesh().triangles(corner, point.triangle)];
  return sum;
}

GONIO_INLINE surface_point posed_scan::in_model_space(surface_point found) const {
  found.position = pose(found.position);
  found.distance *= pose.scale;
  return found;
}

GONIO_INLINE vertex_observations shown_vertices(const point_columns& positions, const point_columns& normals,
                                                const std::vector<char>& shown, double tangential) {
  vertex_observations found = vertex_observations::marked(positions, std::vector<bool>(shown.begin(), shown.end()));
  found.normals = chosen_columns(normals, found.vertices);
  found.tangential = tangential;
  return found;
}

GONIO_INLINE vertex_observations closest_correspondences(const posed_scan& scan, const triangle_mesh& shape,
                                                         const correspondence_options& options, thread_count threads) {
  const point_columns normals = vertex_normals(shape);
  const Eigen::Index count = shape.vertices.cols();
  point_columns positions(3, shape.vertices.cols());
  Eigen::VectorXd weights(shape.vertices.cols());
  std::vector<char> shown(count, 0);  // not bool: threads write neighbouring elements
  for_each_index(
      count, 128,
      [&](Eigen::Index vertex) {
        const surface_point found = scan.closest(shape.vertices.col(vertex));
        positions.col(vertex) = found.position;
        weights[vertex] = scan.weight_at(found);
        // If the scan lacks the vertex, its closest point is on the scan's border.
        shown[vertex] = !found.on_border && found.distance <= options.reach &&
                        scan.normal(found).dot(normals.col(vertex)) >= options.normal_agreement;
      },
      threads);
  vertex_observations known = shown_vertices(positions, normals, shown, options.tangential);
  known.weights.resize(known.positions.cols());
  for (Eigen::Index i = 0; i < std::ssize(known.vertices); ++i) known.weights[i] = weights[known.vertices[i]];
  return known;
}

}  // namespace gonio::shape
