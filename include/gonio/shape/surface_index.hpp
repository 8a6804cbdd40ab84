#pragma once
/// Where a triangulated surface is closest to a point, where a line meets it, and on which side of it a point is.
/// Ericson, "Real-Time Collision Detection" (2005), sections 5.1.5, 5.3.3, 5.3.6 and 6.1; signs by Baerentzen and
/// Aanaes, "Signed distance computation using the angle weighted pseudonormal" (IEEE TVCG 11(3), 2005).

#include <gonio/core/parallel.hpp>
#include <gonio/shape/mesh_topology.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace gonio {

/// A place on a surface that a query found.
struct surface_point {
  Eigen::Vector3d position;
  Eigen::Index triangle = 0;
  Eigen::Vector3d barycentric;  ///< shares of the triangle's corners, which sum to 1
  bool on_border = false;       ///< on an edge of a single triangle: the surface may go on, but is missing
  double distance = 0.0;        ///< to where the query started, not negative
};

namespace detail {

/// Shares of a triangle's corners below which a point is on the opposite side.
inline constexpr double on_side = 1e-9;

/// The shares of the corners in the point of a triangle that is closest to `point`: where it projects to or, if that is
/// outside, the closest point of a side. Triangles without area consist of their sides.
[[nodiscard]] Eigen::Vector3d closest_barycentric(const Eigen::Matrix3d& corners, const Eigen::Vector3d& point);

/// Where a line meets a triangle.
struct line_hit {
  double along;  ///< from where the line begins, in lengths of its direction
  Eigen::Vector3d barycentric;
};

/// Moeller and Trumbore's test. Sides belong to the triangle with a little slack, so that no line slips between two
/// triangles. A triangle seen edge-on is not met.
[[nodiscard]] std::optional<line_hit> meet(const Eigen::Matrix3d& corners, const Eigen::Vector3d& origin,
                                           const Eigen::Vector3d& line);

/// A box along the axes, by its middle; a little larger than asked for, so that its bounds hold after rounding.
struct centred_box {
  static constexpr double slack = 1e-12;

  explicit centred_box(const Eigen::AlignedBox3d& box);

  Eigen::Vector3d centre, half_size;

  [[nodiscard]] double squared_distance(const Eigen::Vector3d& point) const;

  /// Does a line of a direction of length 1 pass through it? None of the three axes across the line and an axis of
  /// space separates them.
  [[nodiscard]] bool meets_line(const Eigen::Vector3d& origin, const Eigen::Vector3d& line) const;
};

/// Boxes around the triangles of a mesh, in a binary tree.
class box_tree {
 public:
  /// O(n log n) for n triangles.
  explicit box_tree(const triangle_mesh& mesh);

  /// Calls `visit` with the number of each triangle in a box whose `bound` is at most `limit`, near ones first. `visit`
  /// returns the limit from then on.
  template <class Bound, class Visit>
  void search(double limit, const Bound& bound, const Visit& visit) const {
    std::array<std::pair<double, std::size_t>, 64> pending;  // one for each halving of the triangles
    std::size_t size = 0;
    pending[size++] = {bound(nodes_[0].box), 0};
    while (size > 0) {
      const auto [least, place] = pending[--size];
      if (least > limit) continue;
      const node& here = nodes_[place];
      if (here.second == 0) {
        for (std::size_t i = here.begin; i < here.end; ++i) limit = visit(order_[i]);
        continue;
      }
      pending[size] = {bound(nodes_[here.second].box), here.second};
      pending[size + 1] = {bound(nodes_[place + 1].box), place + 1};
      if (pending[size].first < pending[size + 1].first) std::swap(pending[size], pending[size + 1]);
      size += 2;
    }
  }

 private:
  /// The first child follows its parent; `second` is 0 for a leaf.
  struct node {
    centred_box box;
    std::size_t begin, end, second;
  };

  static constexpr std::size_t leaf_size = 4;

  std::size_t build(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t begin, std::size_t end);

  std::vector<Eigen::Index> order_;
  std::vector<node> nodes_;
};

}  // namespace detail

/// A surface to ask about places. Copies are cheap: they share what was built. All queries may run at the same time.
///
/// The triangles are in a tree of boxes of our own. A tree of their centroids (nanoflann) has to search as far beyond
/// the best triangle as the largest one reaches, and does not help with lines: it was measured as fast for points near
/// an even mesh, and eight times slower where a part of the triangles is eight times as long.
class surface_index {
 public:
  /// O(n log n) for n triangles. Throws gonio::error as `mesh_topology` does.
  explicit surface_index(triangle_mesh mesh) : surface_(std::make_shared<const built_surface>(std::move(mesh))) {}

  [[nodiscard]] const triangle_mesh& mesh() const noexcept { return surface_->mesh; }
  [[nodiscard]] const mesh_topology& topology() const noexcept { return surface_->topology; }

  /// The closest point of the surface, to rounding; of triangles at the same distance that of the lowest number. About
  /// O(log n) near the surface. Throws gonio::error if the point is not finite or the
  /// square of the distance is not.
  [[nodiscard]] surface_point closest(const Eigen::Vector3d& point) const;

  /// Where the line through `origin` meets the surface nearest to it, both ways and at most `reach` away, in the unit
  /// of the mesh whatever the length of `line`. Triangles seen edge-on are not met. Throws gonio::error unless all
  /// is finite (`reach` may be infinite), the direction is not zero and `reach` is not negative.
  [[nodiscard]] std::optional<surface_point> along(const Eigen::Vector3d& origin, const Eigen::Vector3d& line,
                                                   double reach) const;

  /// The outward normal by which signs are decided: the triangle's; on an edge the mean of its triangles'; at a vertex
  /// the mean of its triangles' by their angles there. Of length 1, or zero if none of these triangles has an area.
  [[nodiscard]] Eigen::Vector3d pseudonormal(const surface_point& place) const;

  /// The distance to the surface, positive on the outside. The sign is that of Baerentzen and Aanaes, who prove it for
  /// closed surfaces; interpolated vertex normals have it wrong near sharp edges. Beyond a border it tells the sides of
  /// the surface as continued there. Throws gonio::error if the point is not finite.
  [[nodiscard]] double signed_distance(const Eigen::Vector3d& point) const;

 private:
  /// The mesh with all that queries need.
  struct built_surface {
    explicit built_surface(triangle_mesh of);

    triangle_mesh mesh;
    mesh_topology topology;
    detail::box_tree tree;
    Eigen::Matrix3Xi across;  // the triangle beyond the side from each corner to the next, or -1
    point_columns triangle_normals, vertex_normals;
  };

  /// A corner, or the side that begins at a corner, or neither: inside.
  struct feature {
    std::optional<Eigen::Index> corner, side;
  };

  static void require_finite(const Eigen::Vector3d& vector, const char* what);

  [[nodiscard]] static feature feature_of(const Eigen::Vector3d& barycentric);

  [[nodiscard]] bool is_on_border(const surface_point& place) const;

  [[nodiscard]] static Eigen::Matrix3Xi across_sides(const triangle_columns& triangles);

  [[nodiscard]] static point_columns angle_weighted(const triangle_mesh& mesh, const point_columns& normals);

  std::shared_ptr<const built_surface> surface_;
};

/// `closest` of each column of `points`, in their order. Throws gonio::error if a point is not finite.
[[nodiscard]] std::vector<surface_point> closest_points(const surface_index& surface, const point_columns& points,
                                                        thread_count threads = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/surface_index.ipp>
#endif
