#pragma once
/// Bodies of shape/mesh_part.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/mesh_part.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace gonio::shape::detail {

/// Groups the corners of all triangles into vertices. Triangles that share an edge share its two vertices.
class joined_corners {
 public:
  explicit joined_corners(const triangle_columns& triangles);

  [[nodiscard]] Eigen::Index group_of(Eigen::Index corner) const;

 private:
  [[nodiscard]] static Eigen::Index next(Eigen::Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  void join(Eigen::Index first, Eigen::Index second) { parent_[group_of(first)] = group_of(second); }

  std::vector<Eigen::Index> parent_;
};

GONIO_INLINE joined_corners::joined_corners(const triangle_columns& triangles) : parent_(triangles.size()) {
  std::iota(parent_.begin(), parent_.end(), Eigen::Index{0});
  std::map<std::pair<int, int>, Eigen::Index> from;  // the first corner of each edge, by the edge's vertices
  for (Eigen::Index t = 0; t < triangles.cols(); ++t)
    for (Eigen::Index side = 0; side < 3; ++side)
      from[{triangles(side, t), triangles((side + 1) % 3, t)}] = 3 * t + side;
  for (const auto& [edge, corner] : from) {
    const auto across = from.find({edge.second, edge.first});
    if (across == from.end()) continue;
    join(corner, next(across->second));
    join(next(corner), across->second);
  }
}

GONIO_INLINE Eigen::Index joined_corners::group_of(Eigen::Index corner) const {
  while (parent_[corner] != corner) corner = parent_[corner];
  return corner;
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE triangle_mesh part_of(const triangle_mesh& mesh, const std::vector<bool>& marked) {
  if (std::ssize(marked) != mesh.vertices.cols())
    refuse({marked.size(), " marks for the ", mesh.vertices.cols(), " vertices of a mesh"});
  std::vector<Eigen::Index> kept;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
    if (std::ranges::all_of(mesh.triangles.col(t), [&](int v) { return bool{marked[v]}; })) kept.push_back(t);
  if (kept.empty()) refuse("no triangle has three marked corners: no surface is left");
  triangle_columns triangles(3, std::ssize(kept));
  for (Eigen::Index i = 0; i < std::ssize(kept); ++i) triangles.col(i) = mesh.triangles.col(kept[i]);
  const detail::joined_corners corners(triangles);
  std::map<Eigen::Index, int> numbers;
  std::vector<Eigen::Index> former;
  triangle_mesh part{{}, triangles};
  for (Eigen::Index corner = 0; corner < triangles.size(); ++corner) {
    const auto [entry, is_new] = numbers.try_emplace(corners.group_of(corner), static_cast<int>(former.size()));
    if (is_new) former.push_back(triangles(corner % 3, corner / 3));
    part.triangles(corner % 3, corner / 3) = entry->second;
  }
  part.vertices = chosen_columns(mesh.vertices, former);
  return part;
}

}  // namespace gonio::shape
