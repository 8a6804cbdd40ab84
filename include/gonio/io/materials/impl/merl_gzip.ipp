#pragma once
/// Bodies of io/materials/merl_gzip.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/believable.hpp>
#include <gonio/io/bytes/gzip.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/merl_gzip.hpp>

namespace gonio::io {

GONIO_INLINE brdf_table read_merl_any(std::span<const std::byte> bytes, const std::string& name,
                                      const merl_options& options) {
  if (!is_gzip(bytes)) return read_merl(bytes, name, options);
  // The extents at the start determine the expanded size.
  const auto header = gunzip_prefix(bytes, detail::merl_header_size, name);
  const grid_extents extents = detail::merl_extents(header, name);
  const std::uint64_t size = detail::merl_file_size(extents);
  if (!detail::is_believable(size, detail::freely_claimed_table, bytes.size()))
    gonio::refuse({name, ": a MERL table of ", detail::to_text(extents), " cells cannot fit in ", bytes.size(),
                   " compressed bytes"});
  return read_merl(gunzip(bytes, static_cast<std::size_t>(size), name), name, options);
}

}  // namespace gonio::io
