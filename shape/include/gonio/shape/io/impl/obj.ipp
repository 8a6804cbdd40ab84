#pragma once
/// Bodies of shape/io/obj.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/shape/io/mesh_parts.hpp>
#include <gonio/shape/io/obj.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace gonio::io::detail {

/// Reads the lines of an OBJ with points and polygons.
class obj_reader {
 public:
  obj_reader(std::string_view text, const std::string& name) : text_(text), position_{name} {}

  [[nodiscard]] mesh_parts read();

 private:
  void add(std::string_view line);

  /// Weights and colours may follow the coordinates.
  void add_vertex(std::string_view line);

  void add_face(std::string_view line);

  /// Returns the vertex of v, v/vt, v//vn or v/vt/vn. Vertices are numbered from 1, or backwards from the latest
  /// vertex, which is -1.
  [[nodiscard]] int vertex_of(std::string_view corner);

  [[noreturn]] void refuse_vertex(std::string_view number) const;

  std::string_view text_;
  text_position position_;
  mesh_parts parts_;
  std::size_t largest_ = 0, largest_line_ = 0;  // largest vertex number, from 1, and its line
};

GONIO_INLINE mesh_parts obj_reader::read() {
  for_each_line(text_, position_, [&](std::string_view line) { add(line.substr(0, line.find('#'))); });
  // A face may name vertices of later lines.
  if (largest_ > parts_.vertices()) {
    position_.line = largest_line_;
    refuse_vertex(std::to_string(largest_));
  }
  return std::move(parts_);
}

GONIO_INLINE void obj_reader::add(std::string_view line) {
  // Keywords that neither move nor renumber vertices and polygons. Any other keyword may be damage.
  constexpr std::array<std::string_view, 18> ignored{"vt",     "vn",     "vp",    "l",        "p",        "o",
                                                     "g",      "s",      "mg",    "mtllib",   "lod",      "usemtl",
                                                     "maplib", "usemap", "bevel", "c_interp", "d_interp", "shadow_obj"};
  const std::string_view keyword = read_word(line);
  if (keyword == "v") return add_vertex(line);
  if (keyword == "f") return add_face(line);
  if (std::ranges::find(ignored, keyword) == ignored.end())
    position_.refuse(in_quotes(keyword) + " is not supported in an OBJ file of polygons");
}

GONIO_INLINE void obj_reader::add_vertex(std::string_view line) {
  for (int axis = 0; axis < 3; ++axis)
    parts_.coordinates.push_back(read_number(read_word(line), position_, [] { return std::string("a coordinate"); }));
}

GONIO_INLINE void obj_reader::add_face(std::string_view line) {
  polygon_fan fan(parts_.corners);
  for (std::string_view word = read_word(line); !word.empty(); word = read_word(line)) fan.add(vertex_of(word));
  if (fan.size() < 3) position_.refuse("a face has " + std::to_string(fan.size()) + " vertices, expected at least 3");
}

GONIO_INLINE int obj_reader::vertex_of(std::string_view corner) {
  const std::string_view digits = corner.substr(0, corner.find('/'));
  long long number = 0;
  const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (failed != std::errc() || end != digits.data() + digits.size() ||
      corner.find_first_not_of("-0123456789/") != std::string_view::npos)
    position_.refuse(in_quotes(corner) + ", expected a vertex of a face as v, v/vt, v//vn or v/vt/vn");
  const auto vertices = static_cast<long long>(parts_.vertices());
  if (number == 0 || number < -vertices) refuse_vertex(digits);
  if (number < 0) return static_cast<int>(vertices + number);
  if (const auto named = static_cast<std::size_t>(number); named > largest_) {
    largest_ = named;
    largest_line_ = position_.line;
  }
  return static_cast<int>(number - 1);
}

GONIO_INLINE void obj_reader::refuse_vertex(std::string_view number) const {
  position_.refuse("a face names vertex " + std::string(number) + " of " + std::to_string(parts_.vertices()) +
                   " vertices, counted from 1");
}

GONIO_INLINE mesh_parts read_obj(std::string_view text, const std::string& name) {
  return obj_reader(text, name).read();
}

}  // namespace gonio::io::detail
