#pragma once
/// Bodies of shape/io/ply.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/shape/io/mesh_parts.hpp>
#include <gonio/shape/io/ply.hpp>

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

// ---- PLY: the header --------------------------------------------------------------------------

template <class Number>
[[nodiscard]] double read_ply_number(std::span<const std::byte> bytes, bool swapped) noexcept {
  std::array<std::byte, sizeof(Number)> own{};
  std::ranges::copy(bytes, own.begin());
  if (swapped) std::ranges::reverse(own);
  return static_cast<double>(std::bit_cast<Number>(own));
}

/// A number type. double can represent all its values.
struct ply_type {
  std::string_view name, newer_name;
  std::size_t size;
  bool whole;
  double (*read)(std::span<const std::byte> bytes, bool swapped) noexcept;
};

inline constexpr std::array<ply_type, 8> ply_types{{
    {"char", "int8", 1, true, &read_ply_number<std::int8_t>},
    {"uchar", "uint8", 1, true, &read_ply_number<std::uint8_t>},
    {"short", "int16", 2, true, &read_ply_number<std::int16_t>},
    {"ushort", "uint16", 2, true, &read_ply_number<std::uint16_t>},
    {"int", "int32", 4, true, &read_ply_number<std::int32_t>},
    {"uint", "uint32", 4, true, &read_ply_number<std::uint32_t>},
    {"float", "float32", 4, false, &read_ply_number<float>},
    {"double", "float64", 8, false, &read_ply_number<double>},
}};

/// The meaning of a property. The first three are indices of a point's coordinates.
enum class ply_role : std::size_t { x, y, z, corners, ignored };

struct ply_property {
  std::string_view name;
  std::optional<ply_type> count;  // only for lists
  ply_type value;
  ply_role role = ply_role::ignored;
};

struct ply_element {
  std::string_view name;
  std::size_t count = 0;
  std::vector<ply_property> properties;

  [[nodiscard]] bool has(ply_role role) const {
    return std::ranges::find(properties, role, &ply_property::role) != properties.end();
  }
};

enum class ply_encoding { ascii, little_endian, big_endian };

/// A header. Its names refer to the file's text.
struct ply_header {
  std::optional<ply_encoding> encoding;
  std::vector<ply_element> elements;
  std::size_t vertices = 0;
};

/// Takes the header off the front of a PLY file.
class ply_header_reader {
 public:
  ply_header_reader(std::string_view& text, text_position& position) : text_(text), position_(position) {}

  [[nodiscard]] ply_header read();

 private:
  [[nodiscard]] std::string_view next_line();

  void add(std::string_view line);

  void set_encoding(std::string_view format);

  void add_element(std::string_view line);

  void add_property(std::string_view line);

  [[nodiscard]] ply_type type_named(std::string_view name) const;

  [[nodiscard]] static ply_role role_of(const ply_element& element, const ply_property& property);

  /// Rows without properties take no bytes, so a wrong count of them could not be detected.
  void check(const ply_element& element) const;

  std::string_view& text_;
  text_position& position_;
  ply_header header_;
};

// ---- PLY: the rows ----------------------------------------------------------------------------

class ply_binary_rows {
 public:
  ply_binary_rows(std::string_view body, bool swapped, const text_position& position)
      : bytes_(std::as_bytes(std::span(body)), position.name), swapped_(swapped), name_(position.name) {}

  void begin_row() const noexcept {}
  [[nodiscard]] double read(const ply_type& type) { return type.read(bytes_.read_bytes(type.size), swapped_); }
  void skip(const ply_type& type, std::size_t count) { static_cast<void>(bytes_.read_bytes(count * type.size)); }
  void end_row() const noexcept {}
  void end() const {
    if (bytes_.left() > 0) refuse(std::to_string(bytes_.left()) + " bytes follow the data that its header counts");
  }
  [[noreturn]] void refuse(const std::string& what) const;

 private:
  byte_reader bytes_;
  bool swapped_;
  const std::string& name_;
};

/// The rows of an ascii PLY, one per line.
class ply_text_rows {
 public:
  ply_text_rows(std::string_view body, text_position& position) : left_(body), position_(position) {}

  void begin_row() {
    if (!next_line()) refuse("the file is truncated or its counts are wrong");
  }
  [[nodiscard]] double read(const ply_type&) {
    return read_number(read_field(), position_, [] { return std::string("a value"); });
  }
  void skip(const ply_type&, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) static_cast<void>(read_field());
  }
  void end_row() const;
  void end() {
    if (next_line()) refuse(in_quotes(row_) + " follows the data that the header counts");
  }
  [[noreturn]] void refuse(const std::string& what) const { position_.refuse(what); }

 private:
  /// Goes to the next non-empty line, if there is one.
  [[nodiscard]] bool next_line();
  [[nodiscard]] std::string_view read_field();

  std::string_view left_, row_;
  text_position& position_;
};

template <class Rows>
[[nodiscard]] std::size_t read_ply_count(const ply_property& list, Rows& rows) {
  const double count = rows.read(*list.count);
  if (!(count >= 0.0 && count <= double{std::numeric_limits<std::uint32_t>::max()} && count == std::floor(count)))
    rows.refuse("a list " + in_quotes(list.name) + " has " + shortest(count) + " values");
  return static_cast<std::size_t>(count);
}

template <class Rows>
void read_ply_face(const ply_type& type, std::size_t size, std::size_t vertices, Rows& rows, mesh_parts& parts) {
  if (size < 3) rows.refuse("a face has " + std::to_string(size) + " vertices, expected at least 3");
  polygon_fan fan(parts.corners);
  while (fan.size() < size) {
    const double vertex = rows.read(type);
    if (!(vertex >= 0.0 && vertex < static_cast<double>(vertices) && vertex == std::floor(vertex)))
      rows.refuse("a face names vertex " + shortest(vertex) + ", expected at least 0 and less than " +
                  std::to_string(vertices));
    fan.add(static_cast<int>(vertex));
  }
}

/// Allocates nothing for rows that the file does not have, even if its header counts them.
template <class Rows>
[[nodiscard]] mesh_parts read_ply_elements(const ply_header& header, Rows rows) {
  mesh_parts parts;
  for (const ply_element& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    std::array<double, 3> point{};
    for (std::size_t row = 0; row < element.count; ++row) {
      rows.begin_row();
      for (const ply_property& property : element.properties) {
        const std::size_t count = property.count ? read_ply_count(property, rows) : 1;
        if (property.role == ply_role::ignored)
          rows.skip(property.value, count);
        else if (property.role == ply_role::corners)
          read_ply_face(property.value, count, header.vertices, rows, parts);
        else
          point[static_cast<std::size_t>(property.role)] = rows.read(property.value);
      }
      rows.end_row();
      if (is_vertex) parts.coordinates.insert(parts.coordinates.end(), point.begin(), point.end());
    }
  }
  rows.end();
  return parts;
}

GONIO_INLINE ply_header ply_header_reader::read() {
  if (!text_.starts_with("ply")) gonio::refuse(position_.name + ": is not a PLY file, expected it to begin with 'ply'");
  for (std::string_view line = next_line(); line != "end_header"; line = next_line()) add(line);
  if (!header_.encoding) position_.refuse("the header ends without a format");
  for (const ply_element& element : header_.elements) check(element);
  return header_;
}

GONIO_INLINE std::string_view ply_header_reader::next_line() {
  ++position_.line;
  const std::size_t end = text_.find('\n');
  if (end == std::string_view::npos) position_.refuse("the file is truncated: its header has no line 'end_header'");
  const std::string_view line = trimmed(text_.substr(0, end));
  text_.remove_prefix(end + 1);
  return line;
}

GONIO_INLINE void ply_header_reader::add(std::string_view line) {
  const std::string_view whole = line, keyword = read_word(line);
  if (keyword == "comment" || keyword == "obj_info" || (position_.line == 1 && whole == "ply")) return;
  if (keyword == "format") return set_encoding(trimmed(line));
  if (keyword == "element") return add_element(line);
  if (keyword == "property") return add_property(line);
  position_.refuse(in_quotes(whole) + ", expected format, comment, element, property or end_header");
}

GONIO_INLINE void ply_header_reader::set_encoding(std::string_view format) {
  if (header_.encoding) position_.refuse("the format is given twice");
  if (format == "ascii 1.0") header_.encoding = ply_encoding::ascii;
  if (format == "binary_little_endian 1.0") header_.encoding = ply_encoding::little_endian;
  if (format == "binary_big_endian 1.0") header_.encoding = ply_encoding::big_endian;
  if (!header_.encoding)
    position_.refuse("format " + in_quotes(format) + ", expected ascii, binary_little_endian or binary_big_endian 1.0");
}

GONIO_INLINE void ply_header_reader::add_element(std::string_view line) {
  const std::string_view name = read_word(line);
  const std::string_view digits = trimmed(line);
  std::size_t count = 0;
  const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
  if (failed != std::errc() || end != digits.data() + digits.size())
    position_.refuse("element " + in_quotes(name) + ": " + in_quotes(digits) + ", expected a count");
  if (std::ranges::find(header_.elements, name, &ply_element::name) != header_.elements.end())
    position_.refuse("element " + in_quotes(name) + " is given twice");
  header_.elements.push_back({name, count, {}});
  if (name != "vertex") return;
  if (std::cmp_greater(count, mesh_vertex_limit))
    position_.refuse(std::to_string(count) + " vertices, expected less than 2^31");
  header_.vertices = count;
}

GONIO_INLINE void ply_header_reader::add_property(std::string_view line) {
  if (header_.elements.empty()) position_.refuse("a property comes before the first element");
  ply_element& element = header_.elements.back();
  std::string_view type = read_word(line);
  std::optional<ply_type> count;
  if (type == "list") {
    count = type_named(read_word(line));
    type = read_word(line);
  }
  ply_property property{trimmed(line), count, type_named(type)};
  property.role = role_of(element, property);
  const bool must_be_whole = property.role == ply_role::corners;
  if ((count && !count->whole) || (must_be_whole && !property.value.whole))
    position_.refuse("property " + in_quotes(property.name) + ": a count or vertex number must have an integer type");
  if (property.role != ply_role::ignored && element.has(property.role))
    position_.refuse("property " + in_quotes(property.name) + " is given twice");
  element.properties.push_back(property);
}

GONIO_INLINE ply_type ply_header_reader::type_named(std::string_view name) const {
  const auto type = std::ranges::find_if(
      ply_types, [&](const ply_type& known) { return known.name == name || known.newer_name == name; });
  if (type == ply_types.end()) position_.refuse(in_quotes(name) + " is not a PLY type");
  return *type;
}

GONIO_INLINE ply_role ply_header_reader::role_of(const ply_element& element, const ply_property& property) {
  const std::string_view name = property.name;
  if (element.name == "face" && property.count && (name == "vertex_indices" || name == "vertex_index"))
    return ply_role::corners;
  if (element.name != "vertex" || property.count) return ply_role::ignored;
  return name == "x" ? ply_role::x : name == "y" ? ply_role::y : name == "z" ? ply_role::z : ply_role::ignored;
}

GONIO_INLINE void ply_header_reader::check(const ply_element& element) const {
  if (element.properties.empty() && element.count > 0)
    position_.refuse("element " + in_quotes(element.name) + " has no properties");
  if (element.name == "vertex" && !(element.has(ply_role::x) && element.has(ply_role::y) && element.has(ply_role::z)))
    position_.refuse("element 'vertex' lacks a property x, y or z");
  if (element.name == "face" && !element.has(ply_role::corners))
    position_.refuse("element 'face' lacks a list vertex_indices");
}

GONIO_INLINE void ply_binary_rows::refuse(const std::string& what) const { gonio::refuse(name_ + ": " + what); }

GONIO_INLINE void ply_text_rows::end_row() const {
  if (const std::string_view more = trimmed(row_); !more.empty())
    refuse(in_quotes(more) + " follows the values that the header names");
}

GONIO_INLINE bool ply_text_rows::next_line() {
  for (row_ = {}; row_.empty() && !left_.empty(); ++position_.line) {
    const std::size_t end = left_.find('\n');
    row_ = trimmed(left_.substr(0, end));
    left_.remove_prefix(end == std::string_view::npos ? left_.size() : end + 1);
  }
  return !row_.empty();
}

GONIO_INLINE std::string_view ply_text_rows::read_field() {
  const std::string_view field = read_word(row_);
  if (field.empty()) refuse("the line ends before the values that the header names");
  return field;
}

GONIO_INLINE mesh_parts read_ply(std::string_view text, text_position position) {
  const ply_header header = ply_header_reader(text, position).read();
  if (header.encoding == ply_encoding::ascii) return read_ply_elements(header, ply_text_rows(text, position));
  return read_ply_elements(header, ply_binary_rows(text, header.encoding == ply_encoding::big_endian, position));
}

}  // namespace gonio::io::detail
