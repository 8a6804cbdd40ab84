#pragma once
/// Bodies of shape/mesh_part.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/mesh_part.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace gonio::detail {

GONIO_INLINE joined_corners::joined_corners(const triangle_columns& triangles)
    : parent_(static_cast<std::size_t>(triangles.size())) {
  std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  std::map<std::pair<int, int>, std::size_t> from;  // where an edge begins, by its vertices
  for (Eigen::Index t = 0; t < triangles.cols(); ++t)
    for (Eigen::Index side = 0; side < 3; ++side)
      from[{triangles(side, t), triangles((side + 1) % 3, t)}] = static_cast<std::size_t>(3 * t + side);
  for (const auto& [edge, corner] : from) {
    const auto across = from.find({edge.second, edge.first});
    if (across == from.end()) continue;
    join(corner, next(across->second));
    join(next(corner), across->second);
  }
}

GONIO_INLINE std::size_t joined_corners::group_of(std::size_t corner) const {
  while (parent_[corner] != corner) corner = parent_[corner];
  return corner;
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE triangle_mesh part_of(const triangle_mesh& mesh, const std::vector<bool>& marked) {
  if (marked.size() != static_cast<std::size_t>(mesh.vertices.cols()))
    throw error(std::to_string(marked.size()) + " marks for the " + std::to_string(mesh.vertices.cols()) +
                " vertices of a mesh");
  std::vector<Eigen::Index> kept;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
    if (std::ranges::all_of(mesh.triangles.col(t), [&](int v) { return bool{marked[static_cast<std::size_t>(v)]}; }))
      kept.push_back(t);
  if (kept.empty()) throw error("no triangle has three marked corners: nothing of the surface is left");
  const triangle_columns triangles = mesh.triangles(Eigen::all, kept);
  const detail::joined_corners corners(triangles);
  std::map<std::size_t, int> numbers;
  std::vector<Eigen::Index> former;
  triangle_mesh part{{}, triangles};
  for (Eigen::Index corner = 0; corner < triangles.size(); ++corner) {
    const auto [place, is_new] =
        numbers.try_emplace(corners.group_of(static_cast<std::size_t>(corner)), static_cast<int>(former.size()));
    if (is_new) former.push_back(triangles(corner % 3, corner / 3));
    part.triangles(corner % 3, corner / 3) = place->second;
  }
  part.vertices = mesh.vertices(Eigen::all, former);
  return part;
}

}  // namespace gonio
