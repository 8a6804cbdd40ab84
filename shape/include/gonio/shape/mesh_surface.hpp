#pragma once
/// The points and normals of a mesh that a camera sees through its lens. With them, `capture::samples_of` turns a
/// photograph of an object of known shape into one measurement per pixel (Noell, Koehler and Stricker 2014).

#include <gonio/core/lens_distortion.hpp>
#include <gonio/shape/triangle_mesh.hpp>
#include <gonio/table/surface_image.hpp>

#include <Eigen/Core>

#include <limits>
#include <vector>

namespace gonio::shape {

namespace detail {

struct mesh_hit {
  double distance = std::numeric_limits<double>::infinity();
  Eigen::Index triangle = -1;                        ///< negative: none
  Eigen::Vector3d shares = Eigen::Vector3d::Zero();  ///< barycentric coordinates of the point
};

/// A binary tree of boxes around a mesh's triangles. Each node halves its triangles along the longest side of its box.
class triangle_tree {
 public:
  /// O(n log n) for n triangles. The mesh must outlive the tree.
  explicit triangle_tree(const triangle_mesh& mesh);

  /// Returns the nearest triangle that a ray meets, from either side. If two triangles are equally near, returns the
  /// one with the smaller number.
  [[nodiscard]] mesh_hit nearest(const ray& line) const;

 private:
  struct box_node {
    Eigen::Vector3d low, high;
    Eigen::Index first = 0, count = 0;  ///< triangles of a leaf; count 0: an inner node
    Eigen::Index second_child = 0;      ///< the first child follows its parent
  };

  void add_node(Eigen::Index first, Eigen::Index count);
  void meet(const ray& line, Eigen::Index triangle, mesh_hit& best) const;

  const triangle_mesh& mesh_;
  point_columns centres_;
  std::vector<Eigen::Index> order_;
  std::vector<box_node> nodes_;
};

}  // namespace detail

/// Returns the point of a mesh at each pixel's centre, with the normal interpolated from the triangle's vertices. If
/// the nearest triangle is seen from its inside, the pixel gets no point, because the triangle hides the surfaces
/// behind it. Throws gonio::error if the mesh has no triangle, if a triangle names a missing vertex, or if a vertex is
/// not finite. Usually O((triangles + pixels) log triangles).
/// ```cpp
/// const auto surface = gonio::shape::surface_of(gonio::io::read_mesh("vase.ply"), camera);
/// const auto samples = gonio::capture::samples_of(photograph, surface, camera, lamp, white).samples;
/// ```
[[nodiscard]] surface_image surface_of(const triangle_mesh& mesh, const lens_camera& camera);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/mesh_surface.ipp>
#endif
