#pragma once
/// Reads and writes triangle meshes: PLY (ascii, and binary of either byte order) and Wavefront OBJ. Vertices keep
/// their number in the file, including unused and coincident ones, so that shapes in correspondence match by number.
/// Turk, "The PLY Polygon File Format", 1994; Wavefront Technologies, "Advanced Visualizer Manual", appendix B1.
///
/// Debian's readers crash on damaged files or round coordinates: docs/decisions/0010-mesh-files.md.

#include <gonio/core/rgb.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <filesystem>
#include <span>

namespace gonio::io {

/// Reads a .ply or .obj file, by its extension in upper or lower case. Ignores colours, normals, texture coordinates
/// and other data. Triangles are in the order of the file's polygons, each split into a fan about its first vertex.
/// O(bytes): a million vertices and two million triangles take 0.4 s in binary and 0.8 s in text.
///
/// Throws gonio::error that names the path, and the line if possible, if the file cannot be read, has another
/// extension, is damaged or truncated, holds more or less than its header counts, names a missing vertex, has no
/// triangle, or has a vertex that is not finite. It cannot detect text that is cut off within its last line, or an OBJ
/// cut off after a line. It does not check that the triangles are a surface; `mesh_topology` does.
[[nodiscard]] shape::triangle_mesh read_mesh(const std::filesystem::path& path);

/// Writes a .ply (binary, little-endian, coordinates in double) or .obj file (text). `read_mesh` reads exactly this
/// mesh from it. Throws gonio::error, and keeps an existing file, for another extension, for a mesh that `read_mesh`
/// would refuse, or if the file cannot be written.
void write_mesh(const std::filesystem::path& path, const shape::triangle_mesh& mesh);

/// Writes a .ply file with a colour for each vertex: linear Rec. 709, clipped to [0, 1] and stored as 8 bits in sRGB.
/// Throws gonio::error as `write_mesh` without colours does, for .obj (few programs read its vertex colours), if the
/// numbers of colours and vertices differ, or if a colour is NaN.
void write_mesh(const std::filesystem::path& path, const shape::triangle_mesh& mesh, std::span<const rgb> colours);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/shape/io/impl/mesh.ipp>
#endif
