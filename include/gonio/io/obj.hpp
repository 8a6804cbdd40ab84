#pragma once
/// The reader of Wavefront OBJ files. Wavefront Technologies, "Advanced Visualizer Manual", appendix B1.

#include <gonio/io/mesh_parts.hpp>
#include <gonio/io/text.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace gonio::io::detail {

/// The lines of an OBJ of points and polygons.
class obj_parser {
 public:
  obj_parser(std::string_view text, const std::string& name) : text_(text), place_{name} {}

  [[nodiscard]] mesh_parts parse();

 private:
  void add(std::string_view line);

  /// Weights and colours may follow the coordinates.
  void add_vertex(std::string_view line);

  void add_face(std::string_view line);

  /// The vertex of v, v/vt, v//vn or v/vt/vn: from 1 on, or backwards from -1, the latest one.
  [[nodiscard]] int vertex_of(std::string_view corner);

  [[noreturn]] void refuse_vertex(std::string_view number) const;

  std::string_view text_;
  text_place place_;
  mesh_parts parts_;
  std::size_t largest_ = 0, largest_line_ = 0;  // vertex number from 1, and where it is named
};

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/obj.ipp>
#endif
