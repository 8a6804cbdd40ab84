#pragma once
/// Bodies of shape/geodesic.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/shape/geodesic.hpp>
#include <gonio/shape/mesh_topology.hpp>

#include <algorithm>
#include <concepts>
#include <functional>
#include <limits>
#include <queue>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE Eigen::VectorXd geodesic_distances(const triangle_mesh& mesh, const mesh_topology& topology,
                                                Eigen::Index source) {
  Eigen::VectorXd distances = Eigen::VectorXd::Constant(mesh.vertices.cols(), std::numeric_limits<double>::infinity());
  detail::walk_edges(mesh, topology, source, [&](Eigen::Index vertex, double distance) {
    distances[vertex] = distance;
    return true;
  });
  return distances;
}

}  // namespace gonio
