#pragma once
/// Distances along a surface's edges, and the vertices nearest by them: Dijkstra's algorithm (1959,
/// doi:10.1007/BF01386390). "Statistical surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V,
/// section 3) chooses by such distances the vertices that a missing one is predicted from, so that none is taken from
/// across a fold.
///
/// Paths along edges are never shorter than the true geodesics. On equilateral triangles they are longer by 10% in the
/// mean over all directions and by 15.5% (2/sqrt(3)) at most, however fine the mesh; on a grid of squares cut in two by
/// up to 41% (sqrt(2)), across the cuts. For an order of neighbours on an even mesh, that is close enough.

#include <gonio/shape/mesh_topology.hpp>

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace gonio::shape {

/// The length of the shortest path along edges from a vertex to each, in the unit of the mesh; infinite where there is
/// none. O(vertices log vertices). Throws gonio::error if the topology has another number of vertices than the mesh,
/// the source is none of them or one is not finite.
[[nodiscard]] Eigen::VectorXd geodesic_distances(const triangle_mesh& mesh, const mesh_topology& topology,
                                                 Eigen::Index source);

/// The `count` vertices nearest to a vertex along edges among those that `is_candidate(vertex)` tells, ascending,
/// equally far ones by number; fewer if no more can be reached. The source is one itself if it is a candidate. The walk
/// ends with the last one found. Throws gonio::error as `geodesic_distances`.
[[nodiscard]] std::vector<Eigen::Index> nearest_along_surface(const triangle_mesh& mesh, const mesh_topology& topology,
                                                              Eigen::Index source,
                                                              const std::function<bool(Eigen::Index)>& is_candidate,
                                                              Eigen::Index count);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/geodesic.ipp>
#endif
