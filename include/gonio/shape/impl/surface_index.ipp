#pragma once
/// Bodies of shape/surface_index.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/shape/mesh_topology.hpp>
#include <gonio/shape/surface_index.hpp>

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

namespace gonio::detail {

GONIO_INLINE Eigen::Vector3d closest_barycentric(const Eigen::Matrix3d& corners, const Eigen::Vector3d& point) {
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

GONIO_INLINE std::optional<line_hit> meet(const Eigen::Matrix3d& corners, const Eigen::Vector3d& origin,
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

GONIO_INLINE centred_box::centred_box(const Eigen::AlignedBox3d& box)
    : centre(box.center()), half_size(0.5 * box.sizes() + slack * (box.sizes() + centre.cwiseAbs())) {}

GONIO_INLINE double centred_box::squared_distance(const Eigen::Vector3d& point) const {
  return (1.0 - slack) * ((point - centre).cwiseAbs() - half_size).cwiseMax(0.0).squaredNorm();
}

GONIO_INLINE bool centred_box::meets_line(const Eigen::Vector3d& origin, const Eigen::Vector3d& line) const {
  const Eigen::Vector3d between = origin - centre, size = line.cwiseAbs();
  const Eigen::Vector3d reach(half_size.y() * size.z() + half_size.z() * size.y(),
                              half_size.z() * size.x() + half_size.x() * size.z(),
                              half_size.x() * size.y() + half_size.y() * size.x());
  return (between.cross(line).cwiseAbs() - reach).maxCoeff() <= slack * between.cwiseAbs().maxCoeff();
}

GONIO_INLINE box_tree::box_tree(const triangle_mesh& mesh) : order_(static_cast<std::size_t>(mesh.triangles.cols())) {
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

GONIO_INLINE std::size_t box_tree::build(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t begin,
                                         std::size_t end) {
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

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE surface_point surface_index::closest(const Eigen::Vector3d& point) const {
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

GONIO_INLINE std::optional<surface_point> surface_index::along(const Eigen::Vector3d& origin,
                                                               const Eigen::Vector3d& line, double reach) const {
  require_finite(origin, "the origin of a line");
  require_finite(line, "the direction of a line");
  if (!(line.stableNorm() > 0.0)) throw error("the direction of a line that is to meet a surface is zero");
  if (!(reach >= 0.0))
    throw error("the reach of a line that is to meet a surface must not be negative, and is " + std::to_string(reach));
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

GONIO_INLINE Eigen::Vector3d surface_index::pseudonormal(const surface_point& place) const {
  const auto [corner, side] = feature_of(place.barycentric);
  if (corner) return surface_->vertex_normals.col(mesh().triangles(*corner, place.triangle));
  const Eigen::Vector3d normal = surface_->triangle_normals.col(place.triangle);
  const int neighbour = side ? surface_->across(*side, place.triangle) : -1;
  if (neighbour < 0) return normal;
  return (normal + surface_->triangle_normals.col(neighbour)).stableNormalized();
}

GONIO_INLINE double surface_index::signed_distance(const Eigen::Vector3d& point) const {
  const surface_point place = closest(point);
  return (point - place.position).dot(pseudonormal(place)) < 0.0 ? -place.distance : place.distance;
}

GONIO_INLINE surface_index::built_surface::built_surface(triangle_mesh of)
    : mesh(std::move(of)),
      topology(mesh),
      tree(mesh),
      across(across_sides(mesh.triangles)),
      triangle_normals(unit_columns(area_normals(mesh))),
      vertex_normals(angle_weighted(mesh, triangle_normals)) {}

GONIO_INLINE void surface_index::require_finite(const Eigen::Vector3d& vector, const char* what) {
  if (!vector.allFinite()) throw error(std::string(what) + " is not finite");
}

GONIO_INLINE surface_index::feature surface_index::feature_of(const Eigen::Vector3d& barycentric) {
  for (Eigen::Index corner = 0; corner < 3; ++corner) {
    const Eigen::Index next = (corner + 1) % 3, last = (corner + 2) % 3;
    if (barycentric[last] > detail::on_side) continue;
    if (barycentric[next] <= detail::on_side) return {corner, {}};
    if (barycentric[corner] <= detail::on_side) return {next, {}};
    return {{}, corner};
  }
  return {};
}

GONIO_INLINE bool surface_index::is_on_border(const surface_point& place) const {
  const auto [corner, side] = feature_of(place.barycentric);
  if (corner) return topology().on_border(mesh().triangles(*corner, place.triangle));
  return side && surface_->across(*side, place.triangle) < 0;
}

GONIO_INLINE Eigen::Matrix3Xi surface_index::across_sides(const triangle_columns& triangles) {
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

GONIO_INLINE point_columns surface_index::angle_weighted(const triangle_mesh& mesh, const point_columns& normals) {
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

GONIO_INLINE std::vector<surface_point> closest_points(const surface_index& surface, const point_columns& points,
                                                       thread_count threads) {
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
