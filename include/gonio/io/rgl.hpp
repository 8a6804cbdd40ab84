#pragma once
/// Files of the RGL material database (`.bsdf`): measured isotropic materials in RGB, held in a container of named
/// arrays ("tensor file", version 1.0). Dupuy and Jakob 2018 (doi:10.1145/3272127.3275059); see
/// model/adaptive_brdf.hpp for what the arrays are.
///
/// A container is the text "tensor_file" and a zero, two bytes of version, a uint32 with the number of arrays, and for
/// each of them: a uint16 length and the name, a uint16 number of dimensions, a uint8 type, a uint64 position of its
/// elements in the file and a uint64 extent for each dimension; all little-endian.

#include <gonio/io/file.hpp>
#include <gonio/io/named_files.hpp>
#include <gonio/model/adaptive_brdf.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

namespace detail {

/// An array of a container: its type's code, and its elements where they are in the file's bytes.
struct tensor_field {
  std::uint8_t type = 0;
  std::vector<std::uint64_t> shape;
  std::span<const std::byte> elements;
};

/// The arrays of a container by name, checked against the bytes that there are.
[[nodiscard]] std::map<std::string, tensor_field> tensor_fields(std::span<const std::byte> bytes,
                                                                const std::string& name);

}  // namespace detail

/// A material, and what its file says of it.
struct rgl_material {
  model::adaptive_brdf material;
  std::string description;
};

/// A material from the bytes of a file; `name` is what errors call it. Throws gonio::error if an array is missing or
/// malformed, for an anisotropic material (more than two azimuths of the light) and for one that has spectra alone.
[[nodiscard]] rgl_material parse_rgl(std::span<const std::byte> bytes, const std::string& name);

/// Reads a file.
[[nodiscard]] inline rgl_material read_rgl(const std::filesystem::path& path) {
  return parse_rgl(read_bytes(path), path.string());
}

/// The materials (`.bsdf`) in a folder; see `list_named_files`.
[[nodiscard]] std::vector<named_file> list_rgl_directory(const std::filesystem::path& folder);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/rgl.ipp>
#endif
