#pragma once
/// Bodies of shape/surface_noise.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/shape/mesh_topology.hpp>
#include <gonio/shape/surface_noise.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

namespace gonio {

GONIO_INLINE Eigen::RowVectorXd noise_variances(const triangle_mesh& mesh, const mesh_topology& topology) {
  point_columns rough = mesh.vertices;
  for (int twice = 0; twice < 2; ++twice) rough -= averaged_over_neighbours(topology, rough);
  Eigen::RowVectorXd variances = rough.cwiseProduct(vertex_normals(mesh)).colwise().sum().cwiseAbs2();
  for (int twice = 0; twice < 2; ++twice) variances = averaged_over_neighbours(topology, variances);
  return variances;
}

}  // namespace gonio
