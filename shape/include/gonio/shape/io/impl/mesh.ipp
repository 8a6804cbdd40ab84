#pragma once
/// Bodies of shape/io/mesh.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/shape/io/mesh.hpp>
#include <gonio/shape/io/obj.hpp>
#include <gonio/shape/io/ply.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

enum class mesh_format { ply, obj };

[[nodiscard]] GONIO_INLINE mesh_format mesh_format_of(const std::filesystem::path& path) {
  const std::string extension = path.extension().string(), lower = lower_case(extension);
  if (lower == ".ply") return mesh_format::ply;
  if (lower == ".obj") return mesh_format::obj;
  refuse_file(path, "a mesh has the extension .ply or .obj, not " + in_quotes(std::string_view(extension)));
}

/// Checks a mesh to read or write. `mesh_topology` checks whether it is a surface.
GONIO_INLINE void check_mesh(const shape::triangle_mesh& mesh, const std::filesystem::path& path) {
  const Eigen::Index vertices = mesh.vertices.cols();
  if (vertices > mesh_vertex_limit) refuse_file(path, "has 2^31 or more vertices, which are counted in int");
  if (mesh.triangles.cols() == 0)
    refuse_file(path, "a mesh of " + std::to_string(vertices) + " vertices has no triangles, expected a surface");
  if (!mesh.vertices.allFinite())
    for (Eigen::Index v = 0; v < vertices; ++v)
      if (!mesh.vertices.col(v).allFinite()) refuse_file(path, "vertex " + std::to_string(v) + " is not finite");
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
    for (const int vertex : {mesh.triangles(0, t), mesh.triangles(1, t), mesh.triangles(2, t)})
      if (vertex < 0 || vertex >= vertices)
        refuse_file(path, "triangle " + std::to_string(t) + " names vertex " + std::to_string(vertex) +
                              ", expected at least 0 and less than " + std::to_string(vertices));
}

[[nodiscard]] GONIO_INLINE std::array<std::uint8_t, 3> srgb_codes(const rgb& linear) noexcept {
  const auto code = [](double light) { return static_cast<std::uint8_t>(std::lround(255.0 * encode_srgb(light))); };
  return {code(linear[0]), code(linear[1]), code(linear[2])};
}

/// Writes colours unless `colours` is empty.
GONIO_INLINE void write_ply(const std::filesystem::path& path, const shape::triangle_mesh& mesh,
                            std::span<const rgb> colours) {
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.cols()) +
                       "\nproperty double x\nproperty double y\nproperty double z\n";
  if (!colours.empty()) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  header += "element face " + std::to_string(mesh.triangles.cols()) +
            "\nproperty list uchar int vertex_indices\nend_header\n";
  byte_writer body;
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    body.write_all(std::span<const double>(mesh.vertices.col(v).data(), 3));
    if (!colours.empty()) body.write(srgb_codes(colours[v]));
  }
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    body.write(std::uint8_t{3});
    body.write_all(std::span<const std::int32_t>(mesh.triangles.col(t).data(), 3));
  }
  write_atomically(path, [&](file_writer& file) {
    file.write(std::as_bytes(std::span(header)));
    file.write(body.bytes());
  });
}

GONIO_INLINE void write_obj(const std::filesystem::path& path, const shape::triangle_mesh& mesh) {
  std::string text;
  for (const auto& point : mesh.vertices.colwise())
    text += "v " + shortest(point[0]) + ' ' + shortest(point[1]) + ' ' + shortest(point[2]) + '\n';
  for (const auto& corners : mesh.triangles.colwise())
    text += "f " + std::to_string(corners[0] + 1) + ' ' + std::to_string(corners[1] + 1) + ' ' +
            std::to_string(corners[2] + 1) + '\n';
  write_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE shape::triangle_mesh read_mesh(const std::filesystem::path& path) {
  const detail::mesh_format format = detail::mesh_format_of(path);
  const std::vector<std::byte> bytes = read_bytes(path);
  if (bytes.empty()) refuse_file(path, "is empty, expected a mesh");
  const std::string_view text = as_text(bytes);
  const std::string name = path.string();
  const detail::mesh_parts parts =
      format == detail::mesh_format::ply ? detail::read_ply(text, {name}) : detail::read_obj(text, name);
  const Eigen::Index vertices = parts.vertices(), triangles = parts.corners.size() / 3;
  const shape::triangle_mesh mesh{Eigen::Map<const shape::point_columns>(parts.coordinates.data(), 3, vertices),
                                  Eigen::Map<const shape::triangle_columns>(parts.corners.data(), 3, triangles)};
  detail::check_mesh(mesh, path);
  return mesh;
}

GONIO_INLINE void write_mesh(const std::filesystem::path& path, const shape::triangle_mesh& mesh) {
  const detail::mesh_format format = detail::mesh_format_of(path);
  detail::check_mesh(mesh, path);
  if (format == detail::mesh_format::ply)
    detail::write_ply(path, mesh, {});
  else
    detail::write_obj(path, mesh);
}

GONIO_INLINE void write_mesh(const std::filesystem::path& path, const shape::triangle_mesh& mesh,
                             std::span<const rgb> colours) {
  if (detail::mesh_format_of(path) != detail::mesh_format::ply)
    refuse_file(path, "an OBJ file holds no colours of vertices, expected .ply");
  detail::check_mesh(mesh, path);
  if (std::ssize(colours) != mesh.vertices.cols())
    refuse_file(path, std::to_string(colours.size()) + " colours were given for " +
                          std::to_string(mesh.vertices.cols()) + " vertices");
  const auto bad = std::ranges::find_if(colours, [](const rgb& colour) { return colour.isNaN().any(); });
  if (bad != colours.end())
    refuse_file(path, "the colour of vertex " + std::to_string(bad - colours.begin()) + " is not a number");
  detail::write_ply(path, mesh, colours);
}

}  // namespace gonio::io
