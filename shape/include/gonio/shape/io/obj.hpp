#pragma once
/// The reader of Wavefront OBJ files. Wavefront Technologies, "Advanced Visualizer Manual", appendix B1.

#include <gonio/shape/io/mesh_parts.hpp>

#include <string>
#include <string_view>

namespace gonio::io::detail {

/// Reads the text of an OBJ file. Throws gonio::error that starts with `name` for files that `read_mesh` refuses.
[[nodiscard]] mesh_parts read_obj(std::string_view text, const std::string& name);

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/shape/io/impl/obj.ipp>
#endif
