#pragma once
/// Bodies of shape/mesh_topology.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/mesh_topology.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace gonio::shape {

GONIO_INLINE mesh_topology::mesh_topology(const triangle_columns& triangles, Eigen::Index vertices) {
  require_triangles(triangles, vertices);
  const std::vector<half_edge> edges = half_edges_of(triangles);
  require_two_sided(edges);
  gather(edges, vertices);
  require_single_fans(triangles, vertices);
}

GONIO_INLINE std::span<const int> mesh_topology::neighbours(Eigen::Index vertex) const noexcept {
  const Eigen::Index begin = first_[vertex], end = first_[vertex + 1];
  return std::span(neighbours_).subspan(begin, end - begin);
}

GONIO_INLINE void mesh_topology::require_finite(const triangle_mesh& mesh) {
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v)
    if (!mesh.vertices.col(v).allFinite()) refuse({"vertex ", v, " of a mesh is not finite"});
}

GONIO_INLINE void mesh_topology::require_triangles(const triangle_columns& triangles, Eigen::Index vertices) {
  if (triangles.cols() == 0) refuse({"a mesh of ", vertices, " vertices has no triangles"});
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector3i corners = triangles.col(t);
    if (corners.minCoeff() < 0 || corners.maxCoeff() >= vertices)
      refuse({"triangle ", t, " names vertex ", corners.minCoeff() < 0 ? corners.minCoeff() : corners.maxCoeff(),
              ", expected at least 0 and less than ", vertices});
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
      refuse({"triangle ", t, " of a mesh has one vertex twice"});
  }
}

GONIO_INLINE std::vector<mesh_topology::half_edge> mesh_topology::half_edges_of(const triangle_columns& triangles) {
  std::vector<half_edge> edges;
  edges.reserve(3 * triangles.cols());
  for (const auto& corners : triangles.colwise())
    for (int side = 0; side < 3; ++side) edges.push_back({corners[side], corners[(side + 1) % 3]});
  std::ranges::sort(edges);
  return edges;
}

GONIO_INLINE void mesh_topology::require_two_sided(const std::vector<half_edge>& edges) {
  const auto twice = std::ranges::adjacent_find(edges);
  if (twice != edges.end())
    refuse({"a mesh is not a surface: two triangles run from vertex ", twice->from, " to vertex ", twice->to,
            " in the same direction, so more than two share this edge or one of them is turned over"});
}

GONIO_INLINE void mesh_topology::gather(const std::vector<half_edge>& edges, Eigen::Index vertices) {
  border_.assign(vertices, true);
  std::vector<half_edge> links = edges;
  std::vector<bool> open(border_.size(), false);
  for (const auto& [from, to] : edges) {
    border_[from] = false;  // the vertex is in a triangle
    if (std::ranges::binary_search(edges, half_edge{to, from})) continue;
    links.push_back({to, from});
    open[from] = open[to] = true;
  }
  for (Eigen::Index v = 0; v < std::ssize(border_); ++v) border_[v] = border_[v] || open[v];
  std::ranges::sort(links);
  first_.assign(border_.size() + 1, 0);
  for (const auto& [from, to] : links) {
    ++first_[from + 1];
    neighbours_.push_back(to);
  }
  for (Eigen::Index v = 0; v < std::ssize(border_); ++v) first_[v + 1] += first_[v];
}

GONIO_INLINE void mesh_topology::require_single_fans(const triangle_columns& triangles, Eigen::Index vertices) {
  // The edge opposite to each vertex, for each of its triangles.
  std::vector<std::vector<half_edge>> opposite(vertices);
  for (const auto& corners : triangles.colwise())
    for (int side = 0; side < 3; ++side)
      opposite[corners[side]].push_back({corners[(side + 1) % 3], corners[(side + 2) % 3]});
  for (Eigen::Index v = 0; v < std::ssize(opposite); ++v)
    if (!opposite[v].empty() && !is_one_chain(opposite[v]))
      refuse({"a mesh is not a surface: at vertex ", v, " parts of it touch in one point"});
}

GONIO_INLINE bool mesh_topology::is_one_chain(const std::vector<half_edge>& edges) {
  const auto leaving = [&](int vertex) { return std::ranges::find(edges, vertex, &half_edge::from); };
  // An open chain begins at a vertex without an incoming edge, a closed one anywhere.
  const auto begins = [&](const half_edge& edge) {
    return std::ranges::find(edges, edge.from, &half_edge::to) == edges.end();
  };
  const auto start = std::ranges::find_if(edges, begins);
  const auto first = start == edges.end() ? edges.begin() : start;
  auto edge = first;
  Eigen::Index length = 0;
  do {
    ++length;
    edge = leaving(edge->to);
  } while (edge != edges.end() && edge != first);
  return length == std::ssize(edges);
}

}  // namespace gonio::shape
