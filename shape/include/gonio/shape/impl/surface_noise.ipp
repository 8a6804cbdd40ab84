#pragma once
/// Bodies of shape/surface_noise.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/shape/mesh_topology.hpp>
#include <gonio/shape/surface_noise.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

namespace gonio::shape::detail {

template <class Matrix>
[[nodiscard]] Matrix column_means_over_neighbours(const mesh_topology& topology, const Matrix& values) {
  Matrix means = values;
  for (Eigen::Index v = 0; v < values.cols(); ++v) {
    double count = 1.0;
    for (const int neighbour : topology.neighbours(v)) {
      if (topology.on_border(v) && !topology.on_border(neighbour)) continue;
      means.col(v) += values.col(neighbour);
      count += 1.0;
    }
    means.col(v) /= count;
  }
  return means;
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE point_columns averaged_over_neighbours(const mesh_topology& topology, const point_columns& values) {
  return detail::column_means_over_neighbours(topology, values);
}

GONIO_INLINE Eigen::RowVectorXd averaged_over_neighbours(const mesh_topology& topology,
                                                         const Eigen::RowVectorXd& values) {
  return detail::column_means_over_neighbours(topology, values);
}

GONIO_INLINE Eigen::RowVectorXd noise_variances(const triangle_mesh& mesh, const mesh_topology& topology) {
  point_columns rough = mesh.vertices;
  for (int twice = 0; twice < 2; ++twice) rough -= averaged_over_neighbours(topology, rough);
  const point_columns normals = vertex_normals(mesh);
  Eigen::RowVectorXd variances(rough.cols());
  for (Eigen::Index v = 0; v < rough.cols(); ++v) {
    const double along = rough.col(v).dot(normals.col(v));
    variances[v] = along * along;
  }
  for (int twice = 0; twice < 2; ++twice) variances = averaged_over_neighbours(topology, variances);
  return variances;
}

}  // namespace gonio::shape
