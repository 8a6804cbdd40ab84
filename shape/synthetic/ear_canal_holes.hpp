#pragma once
/// Holes in the scans of ear canals, where a bend hides the wall from the scanner.

#include "ear_canal_mesh.hpp"
#include "ear_canals.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace synthetic {

/// An elliptic hole in (u, v). Lengths are in mm.
struct hole_options {
  double u = 0.5;           ///< of the centre: between the bends
  std::optional<double> v;  ///< of the centre; empty: random
  double length = 4.0;      ///< along the canal
  double share =
      0.3;  ///< of the circumference; at 1 or more, the hole may split the scan, and the smaller part is dropped
  double ragged = 0.15;     ///< amplitude of the edge's waves relative to the edge's radius; below 0.5
  double edge_noise = 0.0;  ///< standard deviation of noise along the normals of vertices near the edge
  double edge_reach = 1.5;  ///< largest distance from the edge of the noisy vertices
  double flaps = 0.0;       ///< probability of a spurious triangle at an edge of the border

  [[nodiscard]] static hole_options large() {
    hole_options options;
    options.length = 7.0;
    options.share = 0.55;
    return options;
  }
  [[nodiscard]] static hole_options small() {
    hole_options options;
    options.length = 3.0;
    options.share = 0.22;
    return options;
  }
};

/// A mesh on a surface with the surface's normals and parameters.
struct sampled_surface {
  gonio::shape::triangle_mesh mesh;
  parameter_columns parameters;
  gonio::shape::point_columns normals;

  /// Removes the triangles that have a vertex for which `property` is false. Then removes parts joined only at a point,
  /// all but the largest part, and unused vertices. Returns the former indices of the remaining vertices. Throws
  /// gonio::error if nothing remains.
  template <class Property>
  std::vector<Eigen::Index> keep_where(Property&& property) {
    std::vector<Eigen::Vector3i> kept;
    for (const auto& corners : mesh.triangles.colwise())
      if (property(corners[0]) && property(corners[1]) && property(corners[2])) kept.push_back(corners);
    while (remove_small_fans(kept)) {
    }
    if (kept.empty())
      gonio::refuse("nothing is left of a scan of " + std::to_string(mesh.vertices.cols()) + " vertices");
    keep_largest_part(kept);
    return renumber(kept);
  }

 private:
  /// Returns the root of an element's group in the union-find array `parent`.
  [[nodiscard]] static Eigen::Index root(std::vector<Eigen::Index>& parent, Eigen::Index one) {
    while (parent[one] != one) one = parent[one] = parent[parent[one]];
    return one;
  }

  /// Keeps only the largest fan of triangles at each vertex. Returns whether triangles were removed.
  bool remove_small_fans(std::vector<Eigen::Vector3i>& triangles) const {
    std::vector<std::vector<Eigen::Index>> around(mesh.vertices.cols());
    for (Eigen::Index t = 0; t < std::ssize(triangles); ++t)
      for (const int vertex : triangles[t]) around[vertex].push_back(t);
    std::vector<bool> removed(triangles.size(), false);
    for (Eigen::Index v = 0; v < std::ssize(around); ++v)
      for (const Eigen::Index t : small_fans(triangles, around[v], static_cast<int>(v))) removed[t] = true;
    Eigen::Index next = 0;
    const auto gone = std::erase_if(triangles, [&](const auto&) { return removed[next++]; });
    return gone > 0;
  }

  /// Returns the triangles around a vertex that are not in its largest fan.
  [[nodiscard]] static std::vector<Eigen::Index> small_fans(const std::vector<Eigen::Vector3i>& triangles,
                                                            const std::vector<Eigen::Index>& around, int vertex) {
    std::vector<Eigen::Index> parent(around.size()), sizes(around.size(), 0), small;
    std::iota(parent.begin(), parent.end(), Eigen::Index{0});
    std::map<int, Eigen::Index> first_with;  // the first triangle with each edge, by the edge's other vertex
    for (Eigen::Index i = 0; i < std::ssize(around); ++i)
      for (const int other : triangles[around[i]]) {
        if (other == vertex) continue;
        const auto [found, is_new] = first_with.try_emplace(other, i);
        if (!is_new) parent[root(parent, i)] = root(parent, found->second);
      }
    for (Eigen::Index i = 0; i < std::ssize(around); ++i) ++sizes[root(parent, i)];
    if (sizes.empty()) return small;
    const Eigen::Index largest = std::ranges::max_element(sizes) - sizes.begin();
    for (Eigen::Index i = 0; i < std::ssize(around); ++i)
      if (root(parent, i) != largest) small.push_back(around[i]);
    return small;
  }

  void keep_largest_part(std::vector<Eigen::Vector3i>& triangles) const {
    const Eigen::Index count = mesh.vertices.cols();
    std::vector<Eigen::Index> parent(count), sizes(count, 0);
    std::iota(parent.begin(), parent.end(), Eigen::Index{0});
    const auto part = [&](int vertex) { return root(parent, vertex); };
    for (const Eigen::Vector3i& corners : triangles)
      for (int side = 0; side < 2; ++side) parent[part(corners[side])] = part(corners[side + 1]);
    for (const Eigen::Vector3i& corners : triangles) ++sizes[part(corners[0])];
    const Eigen::Index largest = std::ranges::max_element(sizes) - sizes.begin();
    std::erase_if(triangles, [&](const Eigen::Vector3i& corners) { return part(corners[0]) != largest; });
  }

  std::vector<Eigen::Index> renumber(const std::vector<Eigen::Vector3i>& triangles) {
    std::vector<int> number(mesh.vertices.cols(), -1);
    for (const Eigen::Vector3i& corners : triangles)
      for (const int vertex : corners) number[vertex] = 0;
    std::vector<Eigen::Index> left;
    for (Eigen::Index v = 0; v < std::ssize(number); ++v) {
      if (number[v] < 0) continue;
      number[v] = static_cast<int>(left.size());
      left.push_back(v);
    }
    mesh.triangles.resize(3, std::ssize(triangles));
    for (Eigen::Index t = 0; t < std::ssize(triangles); ++t)
      for (int corner = 0; corner < 3; ++corner) mesh.triangles(corner, t) = number[triangles[t][corner]];
    mesh.vertices = gonio::shape::point_columns(mesh.vertices(Eigen::all, left));
    normals = gonio::shape::point_columns(normals(Eigen::all, left));
    parameters = parameter_columns(parameters(Eigen::all, left));
    return left;
  }
};

class ear_hole {
 public:
  /// Throws gonio::error for a hole without size, an edge that is too ragged, or a negative probability or length.
  ear_hole(const ear_canal& individual, const hole_options& options, number_source& numbers) : options_(options) {
    if (!(options.length > 0.0 && options.share > 0.0))
      gonio::refuse("a hole of a scan must have a length and a share of the circumference above 0");
    if (!(options.ragged >= 0.0 && options.ragged < 0.5 && options.edge_noise >= 0.0 && options.edge_reach >= 0.0 &&
          options.flaps >= 0.0 && options.flaps <= 1.0))
      gonio::refuse(
          "a hole's raggedness must be in [0, 0.5), its noise and reach not negative and the "
          "probability of flaps in [0, 1]");
    const double anywhere = numbers.uniform(0.0, 2.0 * std::numbers::pi);
    v_ = options.v.value_or(anywhere);
    const double speed = (individual.centre(options.u + 0.01) - individual.centre(options.u - 0.01)).norm() / 0.02;
    half_u_ = 0.5 * options.length / speed;
    for (wave& one : waves_) {
      one.size = numbers.uniform(-1.0, 1.0);
      one.phase = numbers.uniform(0.0, 2.0 * std::numbers::pi);
    }
  }

  /// Returns whether a point (u, v) is in the hole.
  [[nodiscard]] bool contains(const Eigen::Vector2d& point) const {
    const double along = (point.x() - options_.u) / half_u_;
    const double round = std::remainder(point.y() - v_, 2.0 * std::numbers::pi) / (std::numbers::pi * options_.share);
    const double direction = std::atan2(round, along);
    double edge = 1.0;
    for (Eigen::Index i = 0; i < std::ssize(waves_); ++i)
      edge += options_.ragged * waves_[i].size * std::cos(static_cast<double>(i + 2) * direction + waves_[i].phase) /
              std::sqrt(static_cast<double>(waves_.size()));
    return std::hypot(along, round) < edge;
  }

  /// Removes the hole's triangles from a scan and disturbs its edge. Throws gonio::error if nothing remains.
  void cut(sampled_surface& sampled, number_source& numbers) const {
    std::vector<bool> inside, on_edge(sampled.parameters.cols(), false);
    for (const auto& point : sampled.parameters.colwise()) inside.push_back(contains(point));
    const auto is_inside = [&](Eigen::Index vertex) { return inside[vertex]; };
    for (const auto& corners : sampled.mesh.triangles.colwise())
      if (is_inside(corners[0]) || is_inside(corners[1]) || is_inside(corners[2]))
        for (const int vertex : corners) on_edge[vertex] = true;
    const auto left = sampled.keep_where([&](Eigen::Index vertex) { return !is_inside(vertex); });
    std::vector<bool> edge_left;
    for (const Eigen::Index former : left) edge_left.push_back(on_edge[former]);
    disturb_edge(sampled, edge_left, numbers);
    add_flaps(sampled, edge_left, numbers);
  }

 private:
  struct wave {
    double size = 0.0, phase = 0.0;
  };

  void disturb_edge(sampled_surface& sampled, const std::vector<bool>& on_edge, number_source& numbers) const {
    if (options_.edge_noise <= 0.0) return;
    const gonio::shape::point_columns before = sampled.mesh.vertices;
    for (Eigen::Index i = 0; i < before.cols(); ++i) {
      double distance = std::numeric_limits<double>::infinity();
      for (Eigen::Index j = 0; j < before.cols(); ++j)
        if (on_edge[j]) distance = std::min(distance, (before.col(i) - before.col(j)).squaredNorm());
      if (distance > options_.edge_reach * options_.edge_reach) continue;
      sampled.mesh.vertices.col(i) += options_.edge_noise * numbers.normal() * sampled.normals.col(i);
    }
  }

  /// Adds triangles from border edges into the hole, each with its own vertex.
  void add_flaps(sampled_surface& sampled, const std::vector<bool>& on_edge, number_source& numbers) const {
    if (options_.flaps <= 0.0) return;
    // The vertex opposite to each half-edge. Half-edges without a partner are on the border.
    std::map<std::pair<int, int>, int> opposite;
    for (const auto& corners : sampled.mesh.triangles.colwise())
      for (int side = 0; side < 3; ++side) opposite[{corners[side], corners[(side + 1) % 3]}] = corners[(side + 2) % 3];
    std::vector<Eigen::Vector3i> flaps;
    std::vector<Eigen::Vector3d> tips;
    for (const auto& [edge, across] : opposite) {
      const auto [from, to] = edge;
      if (opposite.contains({to, from}) || !on_edge[from] || !on_edge[to] || numbers.uniform() >= options_.flaps)
        continue;
      const Eigen::Vector3d middle = 0.5 * (sampled.mesh.vertices.col(from) + sampled.mesh.vertices.col(to));
      const double reach = numbers.uniform(0.7, 2.0), off = 0.4 * numbers.normal();
      flaps.emplace_back(to, from, static_cast<int>(sampled.parameters.cols()) + static_cast<int>(tips.size()));
      tips.emplace_back(middle + reach * (middle - sampled.mesh.vertices.col(across)) +
                        off * sampled.normals.col(from));
    }
    append(sampled, flaps, tips);
  }

  static void append(sampled_surface& sampled, const std::vector<Eigen::Vector3i>& flaps,
                     const std::vector<Eigen::Vector3d>& tips) {
    const Eigen::Index vertices = sampled.parameters.cols(), triangles = sampled.mesh.triangles.cols();
    const Eigen::Index more = std::ssize(flaps);
    sampled.mesh.vertices.conservativeResize(Eigen::NoChange, vertices + more);
    sampled.normals.conservativeResize(Eigen::NoChange, vertices + more);
    sampled.parameters.conservativeResize(Eigen::NoChange, vertices + more);
    sampled.mesh.triangles.conservativeResize(Eigen::NoChange, triangles + more);
    for (Eigen::Index i = 0; i < more; ++i) {
      const Eigen::Index at = i;
      sampled.mesh.vertices.col(vertices + i) = tips[at];
      sampled.normals.col(vertices + i) = sampled.normals.col(flaps[at][0]).eval();
      sampled.parameters.col(vertices + i) = sampled.parameters.col(flaps[at][0]).eval();
      sampled.mesh.triangles.col(triangles + i) = flaps[at];
    }
  }

  hole_options options_;
  double v_ = 0.0, half_u_ = 0.0;
  std::array<wave, 7> waves_{};
};

}  // namespace synthetic
