#pragma once
/// Bodies of shape/geodesic.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/geodesic.hpp>
#include <gonio/shape/mesh_topology.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace gonio::shape::detail {

/// Calls `arrive(vertex, distance)` for each vertex reachable from the source, nearest first, until it returns false.
GONIO_INLINE void walk_edges(const triangle_mesh& mesh, const mesh_topology& topology, Eigen::Index source,
                             const std::function<bool(Eigen::Index vertex, double distance)>& arrive) {
  if (mesh.vertices.cols() != topology.vertices())
    refuse({"a mesh of ", mesh.vertices.cols(), " vertices cannot have a topology of ", topology.vertices()});
  if (source < 0 || source >= topology.vertices())
    refuse({"vertex ", source, " to start from does not exist, expected less than ", topology.vertices()});
  if (!mesh.vertices.allFinite()) refuse("a vertex of the mesh is not finite");
  using step = std::pair<double, Eigen::Index>;
  std::priority_queue<step, std::vector<step>, std::greater<>> pending;
  Eigen::VectorXd distances = Eigen::VectorXd::Constant(topology.vertices(), std::numeric_limits<double>::infinity());
  distances[source] = 0.0;
  pending.emplace(0.0, source);
  while (!pending.empty()) {
    const auto [distance, vertex] = pending.top();
    pending.pop();
    if (distance > distances[vertex]) continue;  // a shorter path reached it before
    if (!arrive(vertex, distance)) return;
    for (const int neighbour : topology.neighbours(vertex)) {
      const Eigen::Vector3d edge = mesh.vertices.col(neighbour) - mesh.vertices.col(vertex);
      const double further = distance + edge.norm();
      if (!(further < distances[neighbour])) continue;
      distances[neighbour] = further;
      pending.emplace(further, neighbour);
    }
  }
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE Eigen::VectorXd geodesic_distances(const triangle_mesh& mesh, const mesh_topology& topology,
                                                Eigen::Index source) {
  Eigen::VectorXd distances = Eigen::VectorXd::Constant(mesh.vertices.cols(), std::numeric_limits<double>::infinity());
  detail::walk_edges(mesh, topology, source, [&](Eigen::Index vertex, double distance) {
    distances[vertex] = distance;
    return true;
  });
  return distances;
}

GONIO_INLINE std::vector<Eigen::Index> nearest_along_surface(const triangle_mesh& mesh, const mesh_topology& topology,
                                                             Eigen::Index source,
                                                             const std::function<bool(Eigen::Index)>& is_candidate,
                                                             Eigen::Index count) {
  std::vector<std::pair<double, Eigen::Index>> found;
  detail::walk_edges(mesh, topology, source, [&](Eigen::Index vertex, double distance) {
    // Include all vertices at the same distance as the last one: they may have lower numbers.
    if (std::ssize(found) >= count && (count == 0 || distance > found[count - 1].first)) return false;
    if (is_candidate(vertex)) found.emplace_back(distance, vertex);
    return true;
  });
  std::ranges::sort(found);
  found.resize(std::min(std::ssize(found), count));
  std::vector<Eigen::Index> nearest;
  nearest.reserve(found.size());
  for (const auto& [distance, vertex] : found) nearest.push_back(vertex);
  return nearest;
}

}  // namespace gonio::shape
