#pragma once
/// Triangle meshes in files: PLY (ascii, and binary of either byte order) and Wavefront OBJ. Vertices keep the number
/// that they have in the file, those of no triangle and those in one place too, so that shapes in correspondence match
/// by it. Turk, "The PLY Polygon File Format", 1994; Wavefront Technologies, "Advanced Visualizer Manual", appendix B1.
///
/// Debian's readers of these formats fall over damaged files, or change the coordinates' last digits:
/// docs/decisions/0010-mesh-files.md.

#include <gonio/core/rgb.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <filesystem>
#include <span>

namespace gonio::io {

/// Reads a .ply or .obj file, whichever the extension says in letters of either case. Colours, normals, texture
/// coordinates and all else are ignored. Triangles come in the order of the file's polygons, each of which is split
/// into a fan about its first vertex. O(bytes): 0.4 s for a million vertices and two million triangles in binary, and
/// 0.8 s in text.
///
/// Throws gonio::error, which names the path, and the line where there is one, if the file cannot be read, has another
/// extension, is damaged or truncated, holds more or less than its header counts, names a vertex that it has not, or
/// has no triangle or a vertex that is not finite. Text that is cut off within its last line, or an OBJ anywhere after
/// a line, cannot be told from a whole file. It is not checked that the triangles are a surface: `mesh_topology` does.
[[nodiscard]] shape::triangle_mesh read_mesh(const std::filesystem::path& path);

/// Writes a .ply (binary, little-endian, coordinates in double) or .obj file (text), of which `read_mesh` reads exactly
/// this mesh. Throws gonio::error, and leaves what was there, if the extension is another, the mesh is not one that
/// `read_mesh` would return, or the file cannot be written.
void write_mesh(const std::filesystem::path& path, const shape::triangle_mesh& mesh);

/// Writes a .ply file with a colour for each vertex: linear Rec. 709, clipped to [0, 1] and stored as 8 bits in sRGB.
/// Throws as the other one does, and if the extension is .obj, which has no colours that all programs know, if there
/// are more or less colours than vertices, or if one is NaN.
void write_mesh(const std::filesystem::path& path, const shape::triangle_mesh& mesh, std::span<const rgb> colours);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/shape/io/impl/mesh.ipp>
#endif
