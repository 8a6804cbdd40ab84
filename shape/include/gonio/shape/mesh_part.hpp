#pragma once
/// Extracts a part of a surface, which is itself a surface.

#include <gonio/shape/triangle_mesh.hpp>

#include <vector>

namespace gonio::shape {

/// Returns the triangles whose corners are all marked, with their vertices. If pieces of the result would touch in a
/// single vertex, each piece gets a copy of that vertex, which keeps the result a surface. O(triangles log triangles).
/// Throws gonio::error if the numbers of marks and vertices differ, and if no triangle remains.
[[nodiscard]] triangle_mesh part_of(const triangle_mesh& mesh, const std::vector<bool>& marked);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/mesh_part.ipp>
#endif
