#pragma once
/// MERL files that may be compressed by gzip, told apart by their content. Needs zlib.

#include <gonio/io/gzip.hpp>
#include <gonio/io/merl.hpp>

namespace gonio::io {

/// A table from the bytes of a MERL file, plain or gzip.
[[nodiscard]] inline brdf_table parse_merl_any(std::span<const std::byte> bytes, const std::string& name,
                                               const merl_options& options = {}) {
  if (!is_gzip(bytes)) return parse_merl(bytes, name, options);
  // The extents at the start say how much more there may be.
  const auto header = gunzip_prefix(bytes, detail::merl_header_size, name);
  const std::uint64_t size = detail::merl_file_size(detail::merl_extents(header, name));
  return parse_merl(gunzip(bytes, static_cast<std::size_t>(size), name), name, options);
}

/// Reads a MERL file, plain or gzip (`.binary`, `.binary.gz`, or any other name).
[[nodiscard]] inline brdf_table read_merl_any(const std::filesystem::path& path, const merl_options& options = {}) {
  return parse_merl_any(read_bytes(path), path.string(), options);
}

}  // namespace gonio::io
