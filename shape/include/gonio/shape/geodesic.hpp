#pragma once
/// Shortest distances along a surface's edges, and the vertices nearest in this distance: Dijkstra's algorithm (1959,
/// doi:10.1007/BF01386390). "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution
/// C.V, section 3) chooses by these distances the vertices that predict a missing one: across a fold the distances are
/// long.
///
/// Paths along edges are never shorter than the true geodesics. On equilateral triangles they are 10% longer on average
/// over all directions and at most 15.5% (2/sqrt(3)), however fine the mesh. On a grid of squares cut in two they are
/// up to 41% (sqrt(2)) longer, in the direction across the cuts.

#include <gonio/shape/mesh_topology.hpp>

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace gonio::shape {

/// Returns the length of the shortest path along edges from a vertex to each other vertex, in the unit of the mesh;
/// infinite if there is none. O(vertices log vertices). Throws gonio::error if topology and mesh have different numbers
/// of vertices, if the source does not exist, or if a vertex is not finite.
[[nodiscard]] Eigen::VectorXd geodesic_distances(const triangle_mesh& mesh, const mesh_topology& topology,
                                                 Eigen::Index source);

/// Returns the `count` candidates nearest to the source along edges, by ascending distance, then number; fewer if no
/// more can be reached. A vertex is a candidate if `is_candidate(vertex)` is true; the source may be one. The search
/// stops at the distance of the last candidate. Throws gonio::error as `geodesic_distances` does.
[[nodiscard]] std::vector<Eigen::Index> nearest_along_surface(const triangle_mesh& mesh, const mesh_topology& topology,
                                                              Eigen::Index source,
                                                              const std::function<bool(Eigen::Index)>& is_candidate,
                                                              Eigen::Index count);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/geodesic.ipp>
#endif
