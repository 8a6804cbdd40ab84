#pragma once
/// A part of a surface that is a surface again.

#include <gonio/core/error.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

namespace detail {

/// The corners of triangles, three for each, in groups that are one vertex: those that an edge of two triangles joins.
class joined_corners {
 public:
  explicit joined_corners(const triangle_columns& triangles);

  [[nodiscard]] std::size_t group_of(std::size_t corner) const;

 private:
  [[nodiscard]] static std::size_t next(std::size_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  void join(std::size_t first, std::size_t second) { parent_[group_of(first)] = group_of(second); }

  std::vector<std::size_t> parent_;
};

}  // namespace detail

/// The triangles of a surface whose corners all are marked, and their vertices. Where what is left would touch in one
/// vertex only, each side gets a vertex of its own, so that it is a surface. O(triangles log triangles). Throws
/// gonio::error for another number of marks than vertices, and if no triangle is left.
[[nodiscard]] triangle_mesh part_of(const triangle_mesh& mesh, const std::vector<bool>& marked);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/mesh_part.ipp>
#endif
