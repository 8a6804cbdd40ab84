#pragma once
/// The reader of PLY files, ascii and binary of either byte order. Turk, "The PLY Polygon File Format", 1994.

#include <gonio/io/text/text.hpp>
#include <gonio/shape/io/mesh_parts.hpp>

#include <string_view>

namespace gonio::io::detail {

/// Reads the bytes of a PLY file. Throws gonio::error that names the file, and the line if it is text, for files that
/// `read_mesh` refuses.
[[nodiscard]] mesh_parts read_ply(std::string_view text, text_position position);

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/shape/io/impl/ply.ipp>
#endif
