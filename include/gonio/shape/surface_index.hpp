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
[[nodiscard]] inline Eigen::Vector3d closest_barycentric(const Eigen::Matrix3d& corners, const Eigen::Vector3d& point) {
  const Eigen::Vector3d first = corners.col(1) - corners.col(0), second = corners.col(2) - corners.col(0),
                        towards = point - corners.col(0), normal = first.cross(second);
  // Below this sine of an angle, 1e-10, rounding decides about the projection.
  if (normal.squaredNorm() > 1e-20 * first.squaredNorm() * second.squaredNorm()) {
    const double of_second = first.cross(towards).dot(normal) / normal.squaredNorm(),
                 of_first = towards.cross(second).dot(normal) / normal.squaredNorm();
    const Eigen::Vector3d inside(1.0 - of_first - of_second, of_first, of_second);
    if (inside.minCoeff() >= 0.0) return inside;
  }
  Eigen::Vector3d best = Eigen::Vector3d::UnitX();
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index from = 0; from < 3; ++from) {
    const Eigen::Index to = (from + 1) % 3;
    const Eigen::Vector3d side = corners.col(to) - corners.col(from);
    const double square = side.squaredNorm(),
                 along = square > 0.0 ? std::clamp((point - corners.col(from)).dot(side) / square, 0.0, 1.0) : 0.0;
    const double distance = (corners.col(from) + along * side - point).squaredNorm();
    if (!(distance < least)) continue;
    least = distance;
    best.setZero();
    best[from] = 1.0 - along;
    best[to] = along;
  }
  return best;
}

/// Where a line meets a triangle.
struct line_hit {
  double along;  ///< from where the line begins, in lengths of its direction
  Eigen::Vector3d barycentric;
};

/// Moeller and Trumbore's test. Sides belong to the triangle with a little slack, so that no line slips between two
/// triangles. A triangle seen edge-on is not met.
[[nodiscard]] inline std::optional<line_hit> meet(const Eigen::Matrix3d& corners, const Eigen::Vector3d& origin,
                                                  const Eigen::Vector3d& line) {
  const Eigen::Vector3d first = corners.col(1) - corners.col(0), second = corners.col(2) - corners.col(0),
                        across = line.cross(second);
  const double volume = first.dot(across);
  if (!(std::abs(volume) > 1e-12 * first.norm() * second.norm())) return {};
  const Eigen::Vector3d towards = origin - corners.col(0), turned = towards.cross(first);
  const double of_first = towards.dot(across) / volume, of_second = line.dot(turned) / volume;
  Eigen::Vector3d barycentric(1.0 - of_first - of_second, of_first, of_second);
  if (!(barycentric.minCoeff() >= -on_side)) return {};
  barycentric = barycentric.cwiseMax(0.0);
  return line_hit{second.dot(turned) / volume, barycentric / barycentric.sum()};
}

/// A box along the axes, by its middle; a little larger than asked for, so that its bounds hold after rounding.
struct centred_box {
  static constexpr double slack = 1e-12;

  explicit centred_box(const Eigen::AlignedBox3d& box)
      : centre(box.center()), half_size(0.5 * box.sizes() + slack * (box.sizes() + centre.cwiseAbs())) {}

  Eigen::Vector3d centre, half_size;

  [[nodiscard]] double squared_distance(const Eigen::Vector3d& point) const {
    return (1.0 - slack) * ((point - centre).cwiseAbs() - half_size).cwiseMax(0.0).squaredNorm();
  }

  /// Does a line of a direction of length 1 pass through it? None of the three axes across the line and an axis of
  /// space separates them.
  [[nodiscard]] bool meets_line(const Eigen::Vector3d& origin, const Eigen::Vector3d& line) const {
    const Eigen::Vector3d between = origin - centre, size = line.cwiseAbs();
    const Eigen::Vector3d reach(half_size.y() * size.z() + half_size.z() * size.y(),
                                half_size.z() * size.x() + half_size.x() * size.z(),
                                half_size.x() * size.y() + half_size.y() * size.x());
    return (between.cross(line).cwiseAbs() - reach).maxCoeff() <= slack * between.cwiseAbs().maxCoeff();
  }
};

/// Boxes around the triangles of a mesh, in a binary tree.
class box_tree {
 public:
  /// O(n log n) for n triangles.
  explicit box_tree(const triangle_mesh& mesh) : order_(static_cast<std::size_t>(mesh.triangles.cols())) {
    std::iota(order_.begin(), order_.end(), Eigen::Index{0});
    std::vector<Eigen::AlignedBox3d> boxes;
    boxes.reserve(order_.size());
    for (const Eigen::Index t : order_) {
      const Eigen::Matrix3d corners = mesh.corners(t);
      boxes.emplace_back(corners.rowwise().minCoeff(), corners.rowwise().maxCoeff());
    }
    nodes_.reserve(order_.size());
    build(boxes, 0, order_.size());
  }

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

  std::size_t build(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t begin, std::size_t end) {
    Eigen::AlignedBox3d all, centres;
    for (std::size_t i = begin; i < end; ++i) {
      const auto& box = boxes[static_cast<std::size_t>(order_[i])];
      all.extend(box);
      centres.extend(box.center());
    }
    const std::size_t place = nodes_.size(), middle = begin + (end - begin) / 2;
    nodes_.push_back({centred_box(all), begin, end, 0});
    if (end - begin <= leaf_size) return place;
    Eigen::Index axis = 0;
    centres.sizes().maxCoeff(&axis);
    const auto key = [&](Eigen::Index t) {
      const auto& box = boxes[static_cast<std::size_t>(t)];
      return std::pair(box.min()[axis] + box.max()[axis], t);
    };
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::ranges::nth_element(at(begin), at(middle), at(end), {}, key);
    build(boxes, begin, middle);
    const std::size_t second = build(boxes, middle, end);
    nodes_[place].second = second;
    return place;
  }

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
  [[nodiscard]] surface_point closest(const Eigen::Vector3d& point) const {
    require_finite(point, "a point to find the closest point of a surface to");
    surface_point best;
    double least = std::numeric_limits<double>::infinity();
    const auto bound = [&](const detail::centred_box& box) { return box.squared_distance(point); };
    surface_->tree.search(least, bound, [&](Eigen::Index t) {
      const Eigen::Matrix3d corners = mesh().corners(t);
      const Eigen::Vector3d barycentric = detail::closest_barycentric(corners, point), position = corners * barycentric;
      const double distance = (position - point).squaredNorm();
      if (std::tie(distance, t) < std::tie(least, best.triangle)) {
        least = distance;
        best.position = position;
        best.triangle = t;
        best.barycentric = barycentric;
      }
      return least;
    });
    if (!(least < std::numeric_limits<double>::infinity()))
      throw error("a point is so far from a surface that the square of the distance is no number");
    best.on_border = is_on_border(best);
    best.distance = std::sqrt(least);
    return best;
  }

  /// Where the line through `origin` meets the surface nearest to it, both ways and at most `reach` away, in the unit
  /// of the mesh whatever the length of `line`. Triangles seen edge-on are not met. Throws gonio::error unless all
  /// is finite (`reach` may be infinite), the direction is not zero and `reach` is not negative.
  [[nodiscard]] std::optional<surface_point> along(const Eigen::Vector3d& origin, const Eigen::Vector3d& line,
                                                   double reach) const {
    require_finite(origin, "the origin of a line");
    require_finite(line, "the direction of a line");
    if (!(line.stableNorm() > 0.0)) throw error("the direction of a line that is to meet a surface is zero");
    if (!(reach >= 0.0))
      throw error("the reach of a line that is to meet a surface must not be negative, and is " +
                  std::to_string(reach));
    const Eigen::Vector3d unit = line.stableNormalized();
    std::optional<surface_point> best;
    // Boxes that the line misses are infinitely far, so the limit is finite.
    const auto squared = [](double distance) {
      return std::min(distance * distance, std::numeric_limits<double>::max());
    };
    const auto bound = [&](const detail::centred_box& box) {
      return box.meets_line(origin, unit) ? box.squared_distance(origin) : std::numeric_limits<double>::infinity();
    };
    surface_->tree.search(squared(reach), bound, [&](Eigen::Index t) {
      const Eigen::Matrix3d corners = mesh().corners(t);
      const std::optional<detail::line_hit> hit = detail::meet(corners, origin, unit);
      const double limit = best ? best->distance : reach, distance = hit ? std::abs(hit->along) : 0.0;
      if (!hit || distance > limit || (best && distance == limit && t > best->triangle)) return squared(limit);
      best = surface_point{corners * hit->barycentric, t, hit->barycentric, false, distance};
      return squared(distance);
    });
    if (best) best->on_border = is_on_border(*best);
    return best;
  }

  /// The outward normal by which signs are decided: the triangle's; on an edge the mean of its triangles'; at a vertex
  /// the mean of its triangles' by their angles there. Of length 1, or zero if none of these triangles has an area.
  [[nodiscard]] Eigen::Vector3d pseudonormal(const surface_point& place) const {
    const auto [corner, side] = feature_of(place.barycentric);
    if (corner) return surface_->vertex_normals.col(mesh().triangles(*corner, place.triangle));
    const Eigen::Vector3d normal = surface_->triangle_normals.col(place.triangle);
    const int neighbour = side ? surface_->across(*side, place.triangle) : -1;
    if (neighbour < 0) return normal;
    return (normal + surface_->triangle_normals.col(neighbour)).stableNormalized();
  }

  /// The distance to the surface, positive on the outside. The sign is that of Baerentzen and Aanaes, who prove it for
  /// closed surfaces; interpolated vertex normals have it wrong near sharp edges. Beyond a border it tells the sides of
  /// the surface as continued there. Throws gonio::error if the point is not finite.
  [[nodiscard]] double signed_distance(const Eigen::Vector3d& point) const {
    const surface_point place = closest(point);
    return (point - place.position).dot(pseudonormal(place)) < 0.0 ? -place.distance : place.distance;
  }

 private:
  /// The mesh with all that queries need.
  struct built_surface {
    explicit built_surface(triangle_mesh of)
        : mesh(std::move(of)),
          topology(mesh),
          tree(mesh),
          across(across_sides(mesh.triangles)),
          triangle_normals(unit_columns(area_normals(mesh))),
          vertex_normals(angle_weighted(mesh, triangle_normals)) {}

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

  static void require_finite(const Eigen::Vector3d& vector, const char* what) {
    if (!vector.allFinite()) throw error(std::string(what) + " is not finite");
  }

  [[nodiscard]] static feature feature_of(const Eigen::Vector3d& barycentric) {
    for (Eigen::Index corner = 0; corner < 3; ++corner) {
      const Eigen::Index next = (corner + 1) % 3, last = (corner + 2) % 3;
      if (barycentric[last] > detail::on_side) continue;
      if (barycentric[next] <= detail::on_side) return {corner, {}};
      if (barycentric[corner] <= detail::on_side) return {next, {}};
      return {{}, corner};
    }
    return {};
  }

  [[nodiscard]] bool is_on_border(const surface_point& place) const {
    const auto [corner, side] = feature_of(place.barycentric);
    if (corner) return topology().on_border(mesh().triangles(*corner, place.triangle));
    return side && surface_->across(*side, place.triangle) < 0;
  }

  [[nodiscard]] static Eigen::Matrix3Xi across_sides(const triangle_columns& triangles) {
    using side_of = std::tuple<int, int, int>;  // from, to, triangle
    std::vector<side_of> sides;
    sides.reserve(static_cast<std::size_t>(triangles.size()));
    const auto count = static_cast<int>(triangles.cols());
    for (int t = 0; t < count; ++t)
      for (int side = 0; side < 3; ++side) sides.emplace_back(triangles(side, t), triangles((side + 1) % 3, t), t);
    std::ranges::sort(sides);
    Eigen::Matrix3Xi across(3, count);
    for (int t = 0; t < count; ++t)
      for (int side = 0; side < 3; ++side) {
        const int from = triangles(side, t), to = triangles((side + 1) % 3, t);
        const auto back = std::ranges::lower_bound(sides, side_of{to, from, 0});
        const bool shared = back != sides.end() && std::get<0>(*back) == to && std::get<1>(*back) == from;
        across(side, t) = shared ? std::get<2>(*back) : -1;
      }
    return across;
  }

  [[nodiscard]] static point_columns angle_weighted(const triangle_mesh& mesh, const point_columns& normals) {
    point_columns sums = point_columns::Zero(3, mesh.vertices.cols());
    for (Eigen::Index t = 0; t < normals.cols(); ++t) {
      const Eigen::Matrix3d corners = mesh.corners(t);
      for (Eigen::Index corner = 0; corner < 3; ++corner) {
        const Eigen::Vector3d next = corners.col((corner + 1) % 3) - corners.col(corner),
                              last = corners.col((corner + 2) % 3) - corners.col(corner);
        const double angle = std::atan2(next.cross(last).norm(), next.dot(last));
        sums.col(mesh.triangles(corner, t)) += angle * normals.col(t);
      }
    }
    return unit_columns(std::move(sums));
  }

  std::shared_ptr<const built_surface> surface_;
};

/// `closest` of each column of `points`, in their order. Throws gonio::error if a point is not finite.
[[nodiscard]] inline std::vector<surface_point> closest_points(const surface_index& surface,
                                                               const point_columns& points, thread_count threads = {}) {
  std::vector<surface_point> found(static_cast<std::size_t>(points.cols()));
  for_each_block(
      found.size(), 256,
      [&](block some) {
        for (std::size_t i = some.begin; i < some.end; ++i)
          found[i] = surface.closest(points.col(static_cast<Eigen::Index>(i)));
      },
      threads);
  return found;
}

}  // namespace gonio
