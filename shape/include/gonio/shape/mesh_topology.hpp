#pragma once
/// Which vertices of a mesh are neighbours, and where the surface ends.

#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

#include <compare>
#include <span>
#include <vector>

namespace gonio::shape {

/// The neighbourhoods of a mesh that is a surface: manifold, oriented, with or without a border.
class mesh_topology {
 public:
  /// O(triangles log triangles). Throws gonio::error naming the first vertex or triangle that keeps a mesh from being
  /// a surface: there is no triangle, a vertex is not finite, a triangle names a vertex that there is not or one twice,
  /// an edge belongs to more than two triangles or to two of opposite orientation, or surfaces touch in one vertex
  /// only. Vertices of no triangle are allowed: scans have them.
  explicit mesh_topology(const triangle_mesh& mesh)
      : mesh_topology(mesh.triangles, (require_finite(mesh), mesh.vertices.cols())) {}

  /// Of triangles alone, among so many vertices.
  mesh_topology(const triangle_columns& triangles, Eigen::Index vertices);

  [[nodiscard]] Eigen::Index vertices() const noexcept { return std::ssize(border_); }

  /// The vertices that an edge joins to this one, ascending.
  [[nodiscard]] std::span<const int> neighbours(Eigen::Index vertex) const noexcept;

  /// Is the vertex on an edge of a single triangle, or on none?
  [[nodiscard]] bool on_border(Eigen::Index vertex) const noexcept { return border_[vertex]; }

 private:
  /// From a vertex to a vertex, along a triangle.
  struct half_edge {
    int from, to;
    [[nodiscard]] friend auto operator<=>(const half_edge&, const half_edge&) = default;
  };

  static void require_finite(const triangle_mesh& mesh);

  static void require_triangles(const triangle_columns& triangles, Eigen::Index vertices);

  [[nodiscard]] static std::vector<half_edge> half_edges_of(const triangle_columns& triangles);

  /// On a surface each triangle goes along an edge in a direction of its own.
  static void require_two_sided(const std::vector<half_edge>& edges);

  void gather(const std::vector<half_edge>& edges, Eigen::Index vertices);

  /// The triangles round a vertex must follow one another in one fan, closed or open.
  static void require_single_fans(const triangle_columns& triangles, Eigen::Index vertices);

  [[nodiscard]] static bool is_one_chain(const std::vector<half_edge>& edges);

  std::vector<Eigen::Index> first_;  // of each vertex in `neighbours_`
  std::vector<int> neighbours_;
  std::vector<bool> border_;
};

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/mesh_topology.ipp>
#endif
