#pragma once
/// Bodies of io/ply.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/byte_stream.hpp>
#include <gonio/io/mesh_parts.hpp>
#include <gonio/io/ply.hpp>
#include <gonio/io/text.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE ply_header ply_header_parser::parse() {
  if (!text_.starts_with("ply")) throw error(place_.name + ": is no PLY file, expected it to begin with 'ply'");
  for (std::string_view line = next_line(); line != "end_header"; line = next_line()) add(line);
  if (!header_.encoding) place_.refuse("the header ends without a format");
  for (const ply_element& element : header_.elements) check(element);
  return header_;
}

GONIO_INLINE std::string_view ply_header_parser::next_line() {
  ++place_.line;
  const std::size_t end = text_.find('\n');
  if (end == std::string_view::npos) place_.refuse("the file is truncated: its header has no line 'end_header'");
  const std::string_view line = trimmed(text_.substr(0, end));
  text_.remove_prefix(end + 1);
  return line;
}

GONIO_INLINE void ply_header_parser::add(std::string_view line) {
  const std::string_view whole = line, keyword = take_word(line);
  if (keyword == "comment" || keyword == "obj_info" || (place_.line == 1 && whole == "ply")) return;
  if (keyword == "format") return set_encoding(trimmed(line));
  if (keyword == "element") return add_element(line);
  if (keyword == "property") return add_property(line);
  place_.refuse(quoted(whole) + ", expected format, comment, element, property or end_header");
}

GONIO_INLINE void ply_header_parser::set_encoding(std::string_view format) {
  if (header_.encoding) place_.refuse("the format is given twice");
  if (format == "ascii 1.0") header_.encoding = ply_encoding::ascii;
  if (format == "binary_little_endian 1.0") header_.encoding = ply_encoding::little_endian;
  if (format == "binary_big_endian 1.0") header_.encoding = ply_encoding::big_endian;
  if (!header_.encoding)
    place_.refuse("format " + quoted(format) + ", expected ascii, binary_little_endian or binary_big_endian 1.0");
}

GONIO_INLINE void ply_header_parser::add_element(std::string_view line) {
  const std::string_view name = take_word(line);
  const std::string_view digits = trimmed(line);
  std::size_t count = 0;
  const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
  if (failed != std::errc() || end != digits.data() + digits.size())
    place_.refuse("element " + quoted(name) + ": " + quoted(digits) + ", expected a count");
  if (std::ranges::find(header_.elements, name, &ply_element::name) != header_.elements.end())
    place_.refuse("element " + quoted(name) + " is given twice");
  header_.elements.push_back({name, count, {}});
  if (name != "vertex") return;
  if (std::cmp_greater(count, mesh_vertex_limit))
    place_.refuse(std::to_string(count) + " vertices, expected less than 2^31");
  header_.vertices = count;
}

GONIO_INLINE void ply_header_parser::add_property(std::string_view line) {
  if (header_.elements.empty()) place_.refuse("a property comes before the first element");
  ply_element& element = header_.elements.back();
  std::string_view type = take_word(line);
  std::optional<ply_type> count;
  if (type == "list") {
    count = type_named(take_word(line));
    type = take_word(line);
  }
  ply_property property{trimmed(line), count, type_named(type)};
  property.role = role_of(element, property);
  const bool must_be_whole = property.role == ply_role::corners;
  if ((count && !count->whole) || (must_be_whole && !property.value.whole))
    place_.refuse("property " + quoted(property.name) + ": a count or vertex number must have a type of integers");
  if (property.role != ply_role::ignored && element.has(property.role))
    place_.refuse("property " + quoted(property.name) + " is given twice");
  element.properties.push_back(property);
}

GONIO_INLINE ply_type ply_header_parser::type_named(std::string_view name) const {
  const auto type = std::ranges::find_if(
      ply_types, [&](const ply_type& known) { return known.name == name || known.newer_name == name; });
  if (type == ply_types.end()) place_.refuse(quoted(name) + " is no type that PLY has");
  return *type;
}

GONIO_INLINE ply_role ply_header_parser::role_of(const ply_element& element, const ply_property& property) {
  const std::string_view name = property.name;
  if (element.name == "face" && property.count && (name == "vertex_indices" || name == "vertex_index"))
    return ply_role::corners;
  if (element.name != "vertex" || property.count) return ply_role::ignored;
  return name == "x" ? ply_role::x : name == "y" ? ply_role::y : name == "z" ? ply_role::z : ply_role::ignored;
}

GONIO_INLINE void ply_header_parser::check(const ply_element& element) const {
  if (element.properties.empty() && element.count > 0)
    place_.refuse("element " + quoted(element.name) + " has no properties");
  if (element.name == "vertex" && !(element.has(ply_role::x) && element.has(ply_role::y) && element.has(ply_role::z)))
    place_.refuse("element 'vertex' lacks a property x, y or z");
  if (element.name == "face" && !element.has(ply_role::corners))
    place_.refuse("element 'face' lacks a list vertex_indices");
}

GONIO_INLINE void ply_binary_rows::refuse(const std::string& what) const { throw error(name_ + ": " + what); }

GONIO_INLINE void ply_text_rows::end_row() const {
  if (const std::string_view more = trimmed(row_); !more.empty())
    refuse(quoted(more) + " follows the values that the header names");
}

GONIO_INLINE bool ply_text_rows::next_line() {
  for (row_ = {}; row_.empty() && !left_.empty(); ++place_.line) {
    const std::size_t end = left_.find('\n');
    row_ = trimmed(left_.substr(0, end));
    left_.remove_prefix(end == std::string_view::npos ? left_.size() : end + 1);
  }
  return !row_.empty();
}

GONIO_INLINE std::string_view ply_text_rows::take_field() {
  const std::string_view field = take_word(row_);
  if (field.empty()) refuse("the line ends before the values that the header names");
  return field;
}

GONIO_INLINE mesh_parts parse_ply(std::string_view text, text_place place) {
  const ply_header header = ply_header_parser(text, place).parse();
  if (header.encoding == ply_encoding::ascii) return take_ply_elements(header, ply_text_rows(text, place));
  return take_ply_elements(header, ply_binary_rows(text, header.encoding == ply_encoding::big_endian, place));
}

}  // namespace gonio::io::detail
