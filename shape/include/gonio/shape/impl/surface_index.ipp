#pragma once
/// Bodies of shape/surface_index.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/shape/mesh_topology.hpp>
#include <gonio/shape/surface_index.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace gonio::shape::detail {

/// If a barycentric coordinate of a point is smaller than this, the point counts as on the opposite side of the
/// triangle.
inline constexpr double on_side = 1e-9;

/// Returns the barycentric coordinates of a triangle's point closest to `point`: its projection or, if that is outside,
/// the closest point of a side. Triangles without area consist of their sides.
[[nodiscard]] GONIO_INLINE Eigen::Vector3d closest_barycentric(const Eigen::Matrix3d& corners,
                                                               const Eigen::Vector3d& point) {
  const std::array<Eigen::Vector3d, 3> corner{corners.col(0), corners.col(1), corners.col(2)};
  const Eigen::Vector3d first = corner[1] - corner[0], second = corner[2] - corner[0], towards = point - corner[0],
                        normal = first.cross(second);
  // If the sine of the angle at corner 0 is below 1e-10, rounding determines the projection.
  if (normal.squaredNorm() > 1e-20 * first.squaredNorm() * second.squaredNorm()) {
    const Eigen::Vector3d beside_first = first.cross(towards), beside_second = towards.cross(second);
    const double of_second = beside_first.dot(normal) / normal.squaredNorm(),
                 of_first = beside_second.dot(normal) / normal.squaredNorm(), of_origin = 1.0 - of_first - of_second;
    if (of_origin >= 0.0 && of_first >= 0.0 && of_second >= 0.0) return {of_origin, of_first, of_second};
  }
  Eigen::Vector3d best(1.0, 0.0, 0.0);
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index from = 0; from < 3; ++from) {
    const Eigen::Index to = (from + 1) % 3;
    const Eigen::Vector3d side = corner[to] - corner[from], away = point - corner[from];
    const double square = side.squaredNorm(),
                 along = square > 0.0 ? std::clamp(away.dot(side) / square, 0.0, 1.0) : 0.0;
    const Eigen::Vector3d apart = away - along * side;
    const double distance = apart.squaredNorm();
    if (!(distance < least)) continue;
    least = distance;
    best.setZero();
    best[from] = 1.0 - along;
    best[to] = along;
  }
  return best;
}

struct line_hit {
  double along;  ///< from the line's origin, in lengths of its direction
  Eigen::Vector3d barycentric;
};

/// Moeller and Trumbore's test. A small slack at the sides keeps lines from slipping between two triangles. A triangle
/// seen edge-on is not hit.
[[nodiscard]] GONIO_INLINE std::optional<line_hit> meet(const Eigen::Matrix3d& corners, const Eigen::Vector3d& origin,
                                                        const Eigen::Vector3d& line) {
  const Eigen::Vector3d corner = corners.col(0), next = corners.col(1), last = corners.col(2), first = next - corner,
                        second = last - corner, across = line.cross(second);
  const double volume = first.dot(across);
  if (!(std::abs(volume) > 1e-12 * first.norm() * second.norm())) return {};
  const Eigen::Vector3d towards = origin - corner, turned = towards.cross(first);
  const double of_first = towards.dot(across) / volume, of_second = line.dot(turned) / volume,
               of_origin = 1.0 - of_first - of_second;
  if (!(of_origin >= -on_side && of_first >= -on_side && of_second >= -on_side)) return {};
  Eigen::Vector3d shares(std::max(of_origin, 0.0), std::max(of_first, 0.0), std::max(of_second, 0.0));
  shares /= shares.sum();
  return line_hit{second.dot(turned) / volume, shares};
}

/// The bounds of points along the axes.
struct extent {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());

  void include(const Eigen::Vector3d& point) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], point[axis]);
      high[axis] = std::max(high[axis], point[axis]);
    }
  }
  [[nodiscard]] Eigen::Vector3d centre() const { return 0.5 * (low + high); }
};

/// An axis-aligned box, by its centre. It is slightly enlarged, so that its bounds hold after rounding.
struct centred_box {
  static constexpr double slack = 1e-12;

  explicit centred_box(const extent& points) : centre(points.centre()) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double size = points.high[axis] - points.low[axis];
      half_size[axis] = 0.5 * size + slack * (size + std::abs(centre[axis]));
    }
  }

  Eigen::Vector3d centre, half_size;

  [[nodiscard]] double squared_distance(const Eigen::Vector3d& point) const {
    double sum = 0.0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double outside = std::max(std::abs(point[axis] - centre[axis]) - half_size[axis], 0.0);
      sum += outside * outside;
    }
    return (1.0 - slack) * sum;
  }

  /// Returns whether a line with a unit direction passes through the box: none of the cross products of the line and
  /// the three coordinate axes is a separating axis.
  [[nodiscard]] bool meets_line(const Eigen::Vector3d& origin, const Eigen::Vector3d& line) const {
    const Eigen::Vector3d between = origin - centre;
    double apart = -std::numeric_limits<double>::infinity(), farthest = 0.0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const Eigen::Index next = (axis + 1) % 3, last = (axis + 2) % 3;
      const double reach = half_size[next] * std::abs(line[last]) + half_size[last] * std::abs(line[next]);
      apart = std::max(apart, std::abs(between[next] * line[last] - between[last] * line[next]) - reach);
      farthest = std::max(farthest, std::abs(between[axis]));
    }
    return apart <= slack * farthest;
  }
};

/// A binary tree of boxes around the triangles of a mesh.
class box_tree {
 public:
  /// O(n log n) for n triangles.
  explicit box_tree(const triangle_mesh& mesh);

  /// Calls `visit` with the number of each triangle in a box whose `bound` is at most `limit`, near boxes first.
  /// `visit` returns the new limit.
  template <class Bound, class Visit>
  void search(double limit, const Bound& bound, const Visit& visit) const {
    std::array<std::pair<double, Eigen::Index>, 64> pending;  // one for each halving of the triangles
    Eigen::Index size = 0;
    pending[size++] = {bound(nodes_[0].box), 0};
    while (size > 0) {
      const auto [least, number] = pending[--size];
      if (least > limit) continue;
      const node& here = nodes_[number];
      if (here.second == 0) {
        for (Eigen::Index i = here.begin; i < here.end; ++i) limit = visit(order_[i]);
        continue;
      }
      pending[size] = {bound(nodes_[here.second].box), here.second};
      pending[size + 1] = {bound(nodes_[number + 1].box), number + 1};
      if (pending[size].first < pending[size + 1].first) std::swap(pending[size], pending[size + 1]);
      size += 2;
    }
  }

 private:
  /// The first child follows its parent; `second` is 0 for a leaf.
  struct node {
    centred_box box;
    Eigen::Index begin, end, second;
  };

  static constexpr Eigen::Index leaf_size = 4;

  Eigen::Index build(const std::vector<extent>& boxes, Eigen::Index begin, Eigen::Index end);

  std::vector<Eigen::Index> order_;
  std::vector<node> nodes_;
};

GONIO_INLINE box_tree::box_tree(const triangle_mesh& mesh) : order_(mesh.triangles.cols()) {
  std::iota(order_.begin(), order_.end(), Eigen::Index{0});
  std::vector<extent> boxes(order_.size());
  for (const Eigen::Index t : order_)
    for (Eigen::Index corner = 0; corner < 3; ++corner) boxes[t].include(mesh.vertices.col(mesh.triangles(corner, t)));
  nodes_.reserve(order_.size());
  build(boxes, 0, order_.size());
}

GONIO_INLINE Eigen::Index box_tree::build(const std::vector<extent>& boxes, Eigen::Index begin, Eigen::Index end) {
  extent all, centres;
  for (Eigen::Index i = begin; i < end; ++i) {
    const extent& box = boxes[order_[i]];
    all.include(box.low);
    all.include(box.high);
    centres.include(box.centre());
  }
  const Eigen::Index number = nodes_.size(), middle = begin + (end - begin) / 2;
  nodes_.push_back({centred_box(all), begin, end, 0});
  if (end - begin <= leaf_size) return number;
  Eigen::Index axis = 0;
  for (const Eigen::Index other : {Eigen::Index{1}, Eigen::Index{2}})
    if (centres.high[other] - centres.low[other] > centres.high[axis] - centres.low[axis]) axis = other;
  const auto key = [&](Eigen::Index t) {
    const extent& box = boxes[t];
    return std::pair(box.low[axis] + box.high[axis], t);
  };
  const auto at = [&](Eigen::Index i) { return order_.begin() + i; };
  std::ranges::nth_element(at(begin), at(middle), at(end), {}, key);
  build(boxes, begin, middle);
  const Eigen::Index second = build(boxes, middle, end);
  nodes_[number].second = second;
  return number;
}

/// The feature of a triangle that contains a point: a corner, the side that begins at a corner, or neither (inside).
struct triangle_feature {
  std::optional<Eigen::Index> corner, side;
};

[[nodiscard]] GONIO_INLINE triangle_feature feature_of(const Eigen::Vector3d& barycentric) {
  for (Eigen::Index corner = 0; corner < 3; ++corner) {
    const Eigen::Index next = (corner + 1) % 3, last = (corner + 2) % 3;
    if (barycentric[last] > on_side) continue;
    if (barycentric[next] <= on_side) return {corner, {}};
    if (barycentric[corner] <= on_side) return {next, {}};
    return {{}, corner};
  }
  return {};
}

/// Returns the triangle across the side from each corner to the next, or -1.
[[nodiscard]] GONIO_INLINE triangle_columns across_sides(const triangle_columns& triangles) {
  using side_of = std::tuple<int, int, int>;  // from, to, triangle
  std::vector<side_of> sides;
  sides.reserve(triangles.size());
  const auto count = static_cast<int>(triangles.cols());
  for (int t = 0; t < count; ++t)
    for (int side = 0; side < 3; ++side) sides.emplace_back(triangles(side, t), triangles((side + 1) % 3, t), t);
  std::ranges::sort(sides);
  triangle_columns across(3, count);
  for (int t = 0; t < count; ++t)
    for (int side = 0; side < 3; ++side) {
      const int from = triangles(side, t), to = triangles((side + 1) % 3, t);
      const auto back = std::ranges::lower_bound(sides, side_of{to, from, 0});
      const bool shared = back != sides.end() && std::get<0>(*back) == to && std::get<1>(*back) == from;
      across(side, t) = shared ? std::get<2>(*back) : -1;
    }
  return across;
}

/// Returns the mean normal at each vertex, weighted by its triangles' angles there.
[[nodiscard]] GONIO_INLINE point_columns angle_weighted(const triangle_mesh& mesh, const point_columns& normals) {
  point_columns sums = point_columns::Zero(3, mesh.vertices.cols());
  for (Eigen::Index t = 0; t < normals.cols(); ++t)
    for (Eigen::Index corner = 0; corner < 3; ++corner)
      sums.col(mesh.triangles(corner, t)) += mesh.angle(t, corner) * normals.col(t);
  return unit_columns(std::move(sums));
}

GONIO_INLINE void require_finite_vector(const Eigen::Vector3d& vector, const char* what) {
  if (!vector.allFinite()) refuse({what, " is not finite"});
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

struct surface_index::built_surface {
  explicit built_surface(triangle_mesh of)
      : mesh(std::move(of)),
        topology(mesh),
        tree(mesh),
        across(detail::across_sides(mesh.triangles)),
        triangle_normals(unit_columns(area_normals(mesh))),
        vertex_normals(detail::angle_weighted(mesh, triangle_normals)) {}

  [[nodiscard]] bool is_on_border(const surface_point& point) const {
    const auto [corner, side] = detail::feature_of(point.barycentric);
    if (corner) return topology.on_border(mesh.triangles(*corner, point.triangle));
    return side && across(*side, point.triangle) < 0;
  }

  triangle_mesh mesh;
  mesh_topology topology;
  detail::box_tree tree;
  triangle_columns across;
  point_columns triangle_normals, vertex_normals;
};

GONIO_INLINE surface_index::surface_index(triangle_mesh mesh)
    : surface_(std::make_shared<const built_surface>(std::move(mesh))) {}

GONIO_INLINE const triangle_mesh& surface_index::mesh() const noexcept { return surface_->mesh; }

GONIO_INLINE const mesh_topology& surface_index::topology() const noexcept { return surface_->topology; }

GONIO_INLINE surface_point surface_index::closest(const Eigen::Vector3d& point) const {
  detail::require_finite_vector(point, "the point to find the closest point for");
  surface_point best;
  double least = std::numeric_limits<double>::infinity();
  const auto bound = [&](const detail::centred_box& box) { return box.squared_distance(point); };
  surface_->tree.search(least, bound, [&](Eigen::Index t) {
    const Eigen::Matrix3d corners = mesh().corners(t);
    const Eigen::Vector3d barycentric = detail::closest_barycentric(corners, point), position = corners * barycentric;
    const Eigen::Vector3d apart = position - point;
    const double distance = apart.squaredNorm();
    if (std::tie(distance, t) < std::tie(least, best.triangle)) {
      least = distance;
      best.position = position;
      best.triangle = t;
      best.barycentric = barycentric;
    }
    return least;
  });
  if (!(least < std::numeric_limits<double>::infinity()))
    refuse("a point is so far from a surface that the squared distance overflows");
  best.on_border = surface_->is_on_border(best);
  best.distance = std::sqrt(least);
  return best;
}

GONIO_INLINE std::optional<surface_point> surface_index::along(const Eigen::Vector3d& origin,
                                                               const Eigen::Vector3d& line, double reach) const {
  detail::require_finite_vector(origin, "the origin of a line");
  detail::require_finite_vector(line, "the direction of a line");
  if (!(line.cwiseAbs().maxCoeff() > 0.0)) refuse("the direction of a line is zero");
  if (!(reach >= 0.0)) refuse({"the reach of a line must be at least 0, not ", reach});
  const Eigen::Vector3d unit = unit_vector(line);
  std::optional<surface_point> best;
  // Boxes that the line misses have infinite distance, so the limit must be finite.
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
  if (best) best->on_border = surface_->is_on_border(*best);
  return best;
}

GONIO_INLINE Eigen::Vector3d surface_index::pseudonormal(const surface_point& point) const {
  const auto [corner, side] = detail::feature_of(point.barycentric);
  if (corner) return surface_->vertex_normals.col(mesh().triangles(*corner, point.triangle));
  const Eigen::Vector3d normal = surface_->triangle_normals.col(point.triangle);
  const int neighbour = side ? surface_->across(*side, point.triangle) : -1;
  if (neighbour < 0) return normal;
  return unit_vector(normal + surface_->triangle_normals.col(neighbour));
}

GONIO_INLINE double surface_index::signed_distance(const Eigen::Vector3d& point) const {
  const surface_point nearest = closest(point);
  const Eigen::Vector3d apart = point - nearest.position;
  return apart.dot(pseudonormal(nearest)) < 0.0 ? -nearest.distance : nearest.distance;
}

GONIO_INLINE std::vector<surface_point> closest_points(const surface_index& surface, const point_columns& points,
                                                       thread_count threads) {
  std::vector<surface_point> found(points.cols());
  for_each_index(
      found.size(), 256, [&](Eigen::Index i) { found[i] = surface.closest(points.col(i)); }, threads);
  return found;
}

}  // namespace gonio::shape
