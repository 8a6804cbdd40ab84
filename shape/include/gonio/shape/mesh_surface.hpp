#pragma once
/// A mesh as a camera sees it: with it, a photograph of an object of known shape is one measurement for each pixel
/// (Noell, Koehler and Stricker 2014; `capture::samples_of`). Each pixel's ray, bent by the lens, is followed to the
/// nearest triangle through a tree of boxes.

#include <gonio/core/lens_distortion.hpp>
#include <gonio/shape/triangle_mesh.hpp>
#include <gonio/table/surface_image.hpp>

#include <Eigen/Core>

#include <limits>
#include <vector>

namespace gonio::shape {

namespace detail {

/// Where a ray meets a mesh.
struct mesh_hit {
  double distance = std::numeric_limits<double>::infinity();
  Eigen::Index triangle = -1;                        ///< negative: nowhere
  Eigen::Vector3d shares = Eigen::Vector3d::Zero();  ///< of the triangle's corners in the place
};

/// The triangles of a mesh in a tree of boxes, halved along their longest sides.
class triangle_tree {
 public:
  /// O(n log n) for n triangles. The mesh must outlive the tree.
  explicit triangle_tree(const triangle_mesh& mesh);

  /// The nearest triangle that a ray meets, from either side; of two at one distance that of the smaller number.
  [[nodiscard]] mesh_hit nearest(const ray& line) const;

 private:
  struct box_node {
    Eigen::Vector3d low, high;
    Eigen::Index first = 0, count = 0;  ///< of the triangles of a leaf; count 0: an inner node
    Eigen::Index second_child = 0;      ///< the first one follows its parent
  };

  void add_node(Eigen::Index first, Eigen::Index count);
  void meet(const ray& line, Eigen::Index triangle, mesh_hit& best) const;

  const triangle_mesh& mesh_;
  point_columns centres_;
  std::vector<Eigen::Index> order_;
  std::vector<box_node> nodes_;
};

}  // namespace detail

/// What each pixel's middle sees of a mesh: the place, and the normal between those of the triangle's vertices. Where
/// the nearest triangle is seen from its inside, nothing is seen, and what lies behind it is hidden. Throws
/// gonio::error if the mesh has no triangle, a triangle of a vertex that is not there, or a vertex that is not finite.
/// O((triangles + pixels) log triangles) as a rule.
/// ```cpp
/// const auto surface = gonio::shape::surface_of(gonio::io::read_mesh("vase.ply"), camera);
/// const auto samples = gonio::capture::samples_of(photograph, surface, camera, lamp, white).samples;
/// ```
[[nodiscard]] surface_image surface_of(const triangle_mesh& mesh, const lens_camera& camera);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/mesh_surface.ipp>
#endif
