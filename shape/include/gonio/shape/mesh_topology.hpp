#pragma once
/// The neighbours of a mesh's vertices, and its border.

#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

#include <compare>
#include <span>
#include <vector>

namespace gonio::shape {

/// The neighbourhoods of a mesh that is a surface: manifold and oriented, with or without a border.
class mesh_topology {
 public:
  /// O(triangles log triangles). Throws gonio::error that names the first vertex or triangle that keeps the mesh from
  /// being a surface: there is no triangle, a vertex is not finite, a triangle names a missing vertex or one vertex
  /// twice, an edge belongs to more than two triangles or to two of opposite orientation, or surfaces touch in a single
  /// vertex. Vertices without a triangle are allowed, because scans have them.
  explicit mesh_topology(const triangle_mesh& mesh)
      : mesh_topology(mesh.triangles, (require_finite(mesh), mesh.vertices.cols())) {}

  /// Takes the triangles and the number of vertices; needs no positions.
  mesh_topology(const triangle_columns& triangles, Eigen::Index vertices);

  [[nodiscard]] Eigen::Index vertices() const noexcept { return std::ssize(border_); }

  /// Returns the vertices joined to this one by an edge, ascending.
  [[nodiscard]] std::span<const int> neighbours(Eigen::Index vertex) const noexcept;

  /// Returns whether the vertex is on an edge of a single triangle, or on no edge.
  [[nodiscard]] bool on_border(Eigen::Index vertex) const noexcept { return border_[vertex]; }

 private:
  /// A directed edge of a triangle.
  struct half_edge {
    int from, to;
    [[nodiscard]] friend auto operator<=>(const half_edge&, const half_edge&) = default;
  };

  static void require_finite(const triangle_mesh& mesh);

  static void require_triangles(const triangle_columns& triangles, Eigen::Index vertices);

  [[nodiscard]] static std::vector<half_edge> half_edges_of(const triangle_columns& triangles);

  /// On a surface, two triangles traverse a shared edge in opposite directions.
  static void require_two_sided(const std::vector<half_edge>& edges);

  void gather(const std::vector<half_edge>& edges, Eigen::Index vertices);

  /// The triangles around a vertex must form a single fan, closed or open.
  static void require_single_fans(const triangle_columns& triangles, Eigen::Index vertices);

  [[nodiscard]] static bool is_one_chain(const std::vector<half_edge>& edges);

  std::vector<Eigen::Index> first_;  // index in `neighbours_` of each vertex's first neighbour
  std::vector<int> neighbours_;
  std::vector<bool> border_;
};

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/mesh_topology.ipp>
#endif
