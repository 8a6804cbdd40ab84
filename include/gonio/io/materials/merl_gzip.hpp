#pragma once
/// MERL files, plain or compressed by gzip, distinguished by their content. Needs zlib.

#include <gonio/io/bytes/gzip.hpp>
#include <gonio/io/materials/merl.hpp>

namespace gonio::io {

/// Reads a table from the bytes of a MERL file, plain or gzip.
[[nodiscard]] brdf_table read_merl_any(std::span<const std::byte> bytes, const std::string& name,
                                       const merl_options& options = {});

/// Reads a MERL file, plain or gzip (`.binary`, `.binary.gz`, or any other name).
[[nodiscard]] inline brdf_table read_merl_any(const std::filesystem::path& path, const merl_options& options = {}) {
  return read_merl_any(read_bytes(path), path.string(), options);
}

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/merl_gzip.ipp>
#endif
