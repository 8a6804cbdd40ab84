#pragma once
/// A part of a surface that is a surface again.

#include <gonio/shape/triangle_mesh.hpp>

#include <vector>

namespace gonio::shape {

/// The triangles of a surface whose corners all are marked, and their vertices. Where what is left would touch in one
/// vertex only, each side gets a vertex of its own, so that it is a surface. O(triangles log triangles). Throws
/// gonio::error for another number of marks than vertices, and if no triangle is left.
[[nodiscard]] triangle_mesh part_of(const triangle_mesh& mesh, const std::vector<bool>& marked);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/mesh_part.ipp>
#endif
