#pragma once
/// Triangle meshes in files: PLY (ascii, and binary of either byte order) and Wavefront OBJ. Vertices keep the number
/// that they have in the file, those of no triangle and those in one place too, so that shapes in correspondence match
/// by it. Turk, "The PLY Polygon File Format", 1994; Wavefront Technologies, "Advanced Visualizer Manual", appendix B1.
///
/// Debian's readers of these formats fall over damaged files, or change the coordinates' last digits:
/// docs/decisions/0010-mesh-files.md.

#include <gonio/core/rgb.hpp>
#include <gonio/io/byte_stream.hpp>
#include <gonio/io/file.hpp>
#include <gonio/io/text.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io {

namespace detail {

enum class mesh_format { ply, obj };

[[nodiscard]] inline mesh_format mesh_format_of(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  std::string lower = extension;
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (lower == ".ply") return mesh_format::ply;
  if (lower == ".obj") return mesh_format::obj;
  refuse_file(path, "a mesh has the extension .ply or .obj, not " + quoted(std::string_view(extension)));
}

/// Takes the next word off the front of a line; it is empty where the line ends.
[[nodiscard]] inline std::string_view take_word(std::string_view& line) noexcept {
  constexpr auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  const auto begin = std::ranges::find_if_not(line, is_blank);
  const auto end = std::ranges::find_if(begin, line.end(), is_blank);
  const std::string_view word(begin, end);
  line = std::string_view(end, line.end());
  return word;
}

/// What a file held so far.
struct mesh_parts {
  std::vector<double> coordinates;  // x, y and z of a vertex adjacent
  std::vector<int> corners;         // the three of a triangle adjacent

  [[nodiscard]] std::size_t vertices() const noexcept { return coordinates.size() / 3; }
};

/// Splits a polygon into a fan about its first vertex. It does not look where the vertices are, so that shapes in
/// correspondence are split alike.
class polygon_fan {
 public:
  explicit polygon_fan(std::vector<int>& corners) noexcept : corners_(corners) {}

  void add(int vertex) {
    if (size_ >= 2) corners_.insert(corners_.end(), {first_, last_, vertex});
    if (size_ == 0) first_ = vertex;
    last_ = vertex;
    ++size_;
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

 private:
  std::vector<int>& corners_;
  std::size_t size_ = 0;
  int first_ = 0, last_ = 0;
};

inline constexpr int mesh_vertex_limit = std::numeric_limits<int>::max();

/// What is asked of a mesh that is read or written; whether it is a surface, `mesh_topology` checks.
inline void check_mesh(const triangle_mesh& mesh, const std::filesystem::path& path) {
  const Eigen::Index vertices = mesh.vertices.cols();
  if (vertices > mesh_vertex_limit) refuse_file(path, "has 2^31 or more vertices, which are counted in int");
  if (mesh.triangles.cols() == 0)
    refuse_file(path, "a mesh of " + std::to_string(vertices) + " vertices has no triangles, expected a surface");
  if (!mesh.vertices.allFinite())
    for (Eigen::Index v = 0; v < vertices; ++v)
      if (!mesh.vertices.col(v).allFinite()) refuse_file(path, "vertex " + std::to_string(v) + " is not finite");
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
    for (const int vertex : {mesh.triangles(0, t), mesh.triangles(1, t), mesh.triangles(2, t)})
      if (vertex < 0 || vertex >= vertices)
        refuse_file(path, "triangle " + std::to_string(t) + " names vertex " + std::to_string(vertex) +
                              " of a mesh of " + std::to_string(vertices));
}

// ---- PLY: the header --------------------------------------------------------------------------

template <class Number>
[[nodiscard]] double decode_ply(std::span<const std::byte> bytes, bool swapped) noexcept {
  std::array<std::byte, sizeof(Number)> own{};
  std::ranges::copy(bytes, own.begin());
  if (swapped) std::ranges::reverse(own);
  return static_cast<double>(std::bit_cast<Number>(own));
}

/// A type of number; double holds all values of each.
struct ply_type {
  std::string_view name, newer_name;
  std::size_t size;
  bool whole;
  double (*decode)(std::span<const std::byte> bytes, bool swapped) noexcept;
};

inline constexpr std::array<ply_type, 8> ply_types{{
    {"char", "int8", 1, true, &decode_ply<std::int8_t>},
    {"uchar", "uint8", 1, true, &decode_ply<std::uint8_t>},
    {"short", "int16", 2, true, &decode_ply<std::int16_t>},
    {"ushort", "uint16", 2, true, &decode_ply<std::uint16_t>},
    {"int", "int32", 4, true, &decode_ply<std::int32_t>},
    {"uint", "uint32", 4, true, &decode_ply<std::uint32_t>},
    {"float", "float32", 4, false, &decode_ply<float>},
    {"double", "float64", 8, false, &decode_ply<double>},
}};

/// What a property says of a mesh. The first three index a point's coordinates.
enum class ply_role : std::size_t { x, y, z, corners, ignored };

struct ply_property {
  std::string_view name;
  std::optional<ply_type> count;  // of lists alone
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

/// The names are those in the file's text.
struct ply_header {
  std::optional<ply_encoding> encoding;
  std::vector<ply_element> elements;
  std::size_t vertices = 0;
};

/// Takes the header off the front of a PLY file.
class ply_header_parser {
 public:
  ply_header_parser(std::string_view& text, text_place& place) : text_(text), place_(place) {}

  [[nodiscard]] ply_header parse() {
    if (!text_.starts_with("ply")) throw error(place_.name + ": is no PLY file, expected it to begin with 'ply'");
    for (std::string_view line = next_line(); line != "end_header"; line = next_line()) add(line);
    if (!header_.encoding) place_.refuse("the header ends without a format");
    for (const ply_element& element : header_.elements) check(element);
    return header_;
  }

 private:
  [[nodiscard]] std::string_view next_line() {
    ++place_.line;
    const std::size_t end = text_.find('\n');
    if (end == std::string_view::npos) place_.refuse("the file is truncated: its header has no line 'end_header'");
    const std::string_view line = trimmed(text_.substr(0, end));
    text_.remove_prefix(end + 1);
    return line;
  }

  void add(std::string_view line) {
    const std::string_view whole = line, keyword = take_word(line);
    if (keyword == "comment" || keyword == "obj_info" || (place_.line == 1 && whole == "ply")) return;
    if (keyword == "format") return set_encoding(trimmed(line));
    if (keyword == "element") return add_element(line);
    if (keyword == "property") return add_property(line);
    place_.refuse(quoted(whole) + ", expected format, comment, element, property or end_header");
  }

  void set_encoding(std::string_view format) {
    if (header_.encoding) place_.refuse("the format is given twice");
    if (format == "ascii 1.0") header_.encoding = ply_encoding::ascii;
    if (format == "binary_little_endian 1.0") header_.encoding = ply_encoding::little_endian;
    if (format == "binary_big_endian 1.0") header_.encoding = ply_encoding::big_endian;
    if (!header_.encoding)
      place_.refuse("format " + quoted(format) + ", expected ascii, binary_little_endian or binary_big_endian 1.0");
  }

  void add_element(std::string_view line) {
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

  void add_property(std::string_view line) {
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

  [[nodiscard]] ply_type type_named(std::string_view name) const {
    const auto type = std::ranges::find_if(
        ply_types, [&](const ply_type& known) { return known.name == name || known.newer_name == name; });
    if (type == ply_types.end()) place_.refuse(quoted(name) + " is no type that PLY has");
    return *type;
  }

  [[nodiscard]] static ply_role role_of(const ply_element& element, const ply_property& property) {
    const std::string_view name = property.name;
    if (element.name == "face" && property.count && (name == "vertex_indices" || name == "vertex_index"))
      return ply_role::corners;
    if (element.name != "vertex" || property.count) return ply_role::ignored;
    return name == "x" ? ply_role::x : name == "y" ? ply_role::y : name == "z" ? ply_role::z : ply_role::ignored;
  }

  /// Rows without properties take no bytes, so that any count of them would be believed.
  void check(const ply_element& element) const {
    if (element.properties.empty() && element.count > 0)
      place_.refuse("element " + quoted(element.name) + " has no properties");
    if (element.name == "vertex" && !(element.has(ply_role::x) && element.has(ply_role::y) && element.has(ply_role::z)))
      place_.refuse("element 'vertex' lacks a property x, y or z");
    if (element.name == "face" && !element.has(ply_role::corners))
      place_.refuse("element 'face' lacks a list vertex_indices");
  }

  std::string_view& text_;
  text_place& place_;
  ply_header header_;
};

// ---- PLY: the rows ----------------------------------------------------------------------------

/// The rows of a binary PLY.
class ply_binary_rows {
 public:
  ply_binary_rows(std::string_view body, bool swapped, const text_place& place)
      : bytes_(std::as_bytes(std::span(body)), place.name), swapped_(swapped), name_(place.name) {}

  void begin_row() const noexcept {}
  [[nodiscard]] double take(const ply_type& type) { return type.decode(bytes_.take_bytes(type.size), swapped_); }
  void skip(const ply_type& type, std::size_t count) { static_cast<void>(bytes_.take_bytes(count * type.size)); }
  void end_row() const noexcept {}
  void end() const {
    if (bytes_.left() > 0) refuse(std::to_string(bytes_.left()) + " bytes follow what its header counts");
  }
  [[noreturn]] void refuse(const std::string& what) const { throw error(name_ + ": " + what); }

 private:
  byte_reader bytes_;
  bool swapped_;
  const std::string& name_;
};

/// The rows of an ascii PLY, each on a line of its own.
class ply_text_rows {
 public:
  ply_text_rows(std::string_view body, text_place& place) : left_(body), place_(place) {}

  void begin_row() {
    if (!next_line()) refuse("the file is truncated or its counts are wrong");
  }
  [[nodiscard]] double take(const ply_type&) {
    return parse_number(take_field(), place_, [] { return std::string("a value"); });
  }
  void skip(const ply_type&, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) static_cast<void>(take_field());
  }
  void end_row() const {
    if (const std::string_view more = trimmed(row_); !more.empty())
      refuse(quoted(more) + " follows the values that the header names");
  }
  void end() {
    if (next_line()) refuse(quoted(row_) + " follows what the header counts");
  }
  [[noreturn]] void refuse(const std::string& what) const { place_.refuse(what); }

 private:
  /// Goes to the next line that holds something, if there is one.
  [[nodiscard]] bool next_line() {
    for (row_ = {}; row_.empty() && !left_.empty(); ++place_.line) {
      const std::size_t end = left_.find('\n');
      row_ = trimmed(left_.substr(0, end));
      left_.remove_prefix(end == std::string_view::npos ? left_.size() : end + 1);
    }
    return !row_.empty();
  }
  [[nodiscard]] std::string_view take_field() {
    const std::string_view field = take_word(row_);
    if (field.empty()) refuse("the line ends before the values that the header names");
    return field;
  }

  std::string_view left_, row_;
  text_place& place_;
};

template <class Rows>
[[nodiscard]] std::size_t take_ply_count(const ply_property& list, Rows& rows) {
  const double count = rows.take(*list.count);
  if (!(count >= 0.0 && count <= double{std::numeric_limits<std::uint32_t>::max()} && count == std::floor(count)))
    rows.refuse("a list " + quoted(list.name) + " has " + shortest(count) + " values");
  return static_cast<std::size_t>(count);
}

template <class Rows>
void take_ply_face(const ply_type& type, std::size_t size, std::size_t vertices, Rows& rows, mesh_parts& parts) {
  if (size < 3) rows.refuse("a face has " + std::to_string(size) + " vertices, expected at least 3");
  polygon_fan fan(parts.corners);
  while (fan.size() < size) {
    const double vertex = rows.take(type);
    if (!(vertex >= 0.0 && vertex < static_cast<double>(vertices) && vertex == std::floor(vertex)))
      rows.refuse("a face names vertex " + shortest(vertex) + " of a mesh of " + std::to_string(vertices));
    fan.add(static_cast<int>(vertex));
  }
}

/// Nothing is allocated for rows that the file does not have, whatever its header counts.
template <class Rows>
[[nodiscard]] mesh_parts take_ply_elements(const ply_header& header, Rows rows) {
  mesh_parts parts;
  for (const ply_element& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    std::array<double, 3> point{};
    for (std::size_t row = 0; row < element.count; ++row) {
      rows.begin_row();
      for (const ply_property& property : element.properties) {
        const std::size_t count = property.count ? take_ply_count(property, rows) : 1;
        if (property.role == ply_role::ignored)
          rows.skip(property.value, count);
        else if (property.role == ply_role::corners)
          take_ply_face(property.value, count, header.vertices, rows, parts);
        else
          point[static_cast<std::size_t>(property.role)] = rows.take(property.value);
      }
      rows.end_row();
      if (is_vertex) parts.coordinates.insert(parts.coordinates.end(), point.begin(), point.end());
    }
  }
  rows.end();
  return parts;
}

[[nodiscard]] inline mesh_parts parse_ply(std::string_view text, text_place place) {
  const ply_header header = ply_header_parser(text, place).parse();
  if (header.encoding == ply_encoding::ascii) return take_ply_elements(header, ply_text_rows(text, place));
  return take_ply_elements(header, ply_binary_rows(text, header.encoding == ply_encoding::big_endian, place));
}

// ---- OBJ --------------------------------------------------------------------------------------

/// The lines of an OBJ of points and polygons.
class obj_parser {
 public:
  obj_parser(std::string_view text, const std::string& name) : text_(text), place_{name} {}

  [[nodiscard]] mesh_parts parse() {
    for_each_line(text_, place_, [&](std::string_view line) { add(line.substr(0, line.find('#'))); });
    // A face may name vertices of lines that follow.
    if (largest_ > parts_.vertices()) {
      place_.line = largest_line_;
      refuse_vertex(std::to_string(largest_));
    }
    return std::move(parts_);
  }

 private:
  void add(std::string_view line) {
    // What neither moves nor renumbers the vertices and polygons. Anything else may be damage.
    constexpr std::array<std::string_view, 18> ignored{
        "vt",     "vn",  "vp",     "l",      "p",      "o",     "g",        "s",        "mg",
        "mtllib", "lod", "usemtl", "maplib", "usemap", "bevel", "c_interp", "d_interp", "shadow_obj"};
    const std::string_view keyword = take_word(line);
    if (keyword == "v") return add_vertex(line);
    if (keyword == "f") return add_face(line);
    if (std::ranges::find(ignored, keyword) == ignored.end())
      place_.refuse(quoted(keyword) + " is not known of an OBJ file of polygons");
  }

  /// Weights and colours may follow the coordinates.
  void add_vertex(std::string_view line) {
    for (int axis = 0; axis < 3; ++axis)
      parts_.coordinates.push_back(parse_number(take_word(line), place_, [] { return std::string("a coordinate"); }));
  }

  void add_face(std::string_view line) {
    polygon_fan fan(parts_.corners);
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) fan.add(vertex_of(word));
    if (fan.size() < 3) place_.refuse("a face has " + std::to_string(fan.size()) + " vertices, expected at least 3");
  }

  /// The vertex of v, v/vt, v//vn or v/vt/vn: from 1 on, or backwards from -1, the latest one.
  [[nodiscard]] int vertex_of(std::string_view corner) {
    const std::string_view digits = corner.substr(0, corner.find('/'));
    long long number = 0;
    const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (failed != std::errc() || end != digits.data() + digits.size() ||
        corner.find_first_not_of("-0123456789/") != std::string_view::npos)
      place_.refuse(quoted(corner) + ", expected a vertex of a face as v, v/vt, v//vn or v/vt/vn");
    const auto vertices = static_cast<long long>(parts_.vertices());
    if (number == 0 || number < -vertices || number > mesh_vertex_limit) refuse_vertex(digits);
    if (number < 0) return static_cast<int>(vertices + number);
    if (const auto named = static_cast<std::size_t>(number); named > largest_) {
      largest_ = named;
      largest_line_ = place_.line;
    }
    return static_cast<int>(number - 1);
  }

  [[noreturn]] void refuse_vertex(std::string_view number) const {
    place_.refuse("a face names vertex " + std::string(number) + " of " + std::to_string(parts_.vertices()) +
                  ", which are counted from 1");
  }

  std::string_view text_;
  text_place place_;
  mesh_parts parts_;
  std::size_t largest_ = 0, largest_line_ = 0;  // vertex number from 1, and where it is named
};

// ---- writing ----------------------------------------------------------------------------------

[[nodiscard]] inline std::array<std::uint8_t, 3> srgb_codes(const rgb& linear) noexcept {
  const auto code = [](double light) { return static_cast<std::uint8_t>(std::lround(255.0 * encode_srgb(light))); };
  return {code(linear[0]), code(linear[1]), code(linear[2])};
}

/// Of no colours where there are none to write.
inline void write_ply(const std::filesystem::path& path, const triangle_mesh& mesh, std::span<const rgb> colours) {
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.cols()) +
                       "\nproperty double x\nproperty double y\nproperty double z\n";
  if (!colours.empty()) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  header += "element face " + std::to_string(mesh.triangles.cols()) +
            "\nproperty list uchar int vertex_indices\nend_header\n";
  byte_writer body;
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    body.put_all(std::span<const double>(mesh.vertices.col(v).data(), 3));
    if (!colours.empty()) body.put(srgb_codes(colours[static_cast<std::size_t>(v)]));
  }
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    body.put(std::uint8_t{3});
    body.put_all(std::span<const std::int32_t>(mesh.triangles.col(t).data(), 3));
  }
  write_atomically(path, [&](file_writer& file) {
    file.write(std::as_bytes(std::span(header)));
    file.write(body.bytes());
  });
}

inline void write_obj(const std::filesystem::path& path, const triangle_mesh& mesh) {
  std::string text;
  for (const auto& point : mesh.vertices.colwise())
    text += "v " + shortest(point[0]) + ' ' + shortest(point[1]) + ' ' + shortest(point[2]) + '\n';
  for (const auto& corners : mesh.triangles.colwise())
    text += "f " + std::to_string(corners[0] + 1) + ' ' + std::to_string(corners[1] + 1) + ' ' +
            std::to_string(corners[2] + 1) + '\n';
  write_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace detail

/// Reads a .ply or .obj file, whichever the extension says in letters of either case. Colours, normals, texture
/// coordinates and all else are ignored. Triangles come in the order of the file's polygons, each of which is split
/// into a fan about its first vertex. O(bytes): 0.3 s for a million vertices and two million triangles in binary, and
/// 0.6 s in text.
///
/// Throws gonio::error, which names the path, and the line where there is one, if the file cannot be read, has another
/// extension, is damaged or truncated, holds more or less than its header counts, names a vertex that it has not, or
/// has no triangle or a vertex that is not finite. Text that is cut off within its last line, or an OBJ anywhere after
/// a line, cannot be told from a whole file. It is not checked that the triangles are a surface: `mesh_topology` does.
[[nodiscard]] inline triangle_mesh read_mesh(const std::filesystem::path& path) {
  const detail::mesh_format format = detail::mesh_format_of(path);
  const std::vector<std::byte> bytes = read_bytes(path);
  if (bytes.empty()) detail::refuse_file(path, "is empty, expected a mesh");
  const std::string_view text = detail::as_text(bytes);
  const std::string name = path.string();
  const detail::mesh_parts parts =
      format == detail::mesh_format::ply ? detail::parse_ply(text, {name}) : detail::obj_parser(text, name).parse();
  const auto vertices = static_cast<Eigen::Index>(parts.vertices()),
             triangles = static_cast<Eigen::Index>(parts.corners.size() / 3);
  const triangle_mesh mesh{Eigen::Map<const point_columns>(parts.coordinates.data(), 3, vertices),
                           Eigen::Map<const triangle_columns>(parts.corners.data(), 3, triangles)};
  detail::check_mesh(mesh, path);
  return mesh;
}

/// Writes a .ply (binary, little-endian, coordinates in double) or .obj file (text), of which `read_mesh` reads exactly
/// this mesh. Throws gonio::error, and leaves what was there, if the extension is another, the mesh is not one that
/// `read_mesh` would return, or the file cannot be written.
inline void write_mesh(const std::filesystem::path& path, const triangle_mesh& mesh) {
  const detail::mesh_format format = detail::mesh_format_of(path);
  detail::check_mesh(mesh, path);
  if (format == detail::mesh_format::ply)
    detail::write_ply(path, mesh, {});
  else
    detail::write_obj(path, mesh);
}

/// Writes a .ply file with a colour for each vertex: linear Rec. 709, clipped to [0, 1] and stored as 8 bits in sRGB.
/// Throws as the other one does, and if the extension is .obj, which has no colours that all programs know, if there
/// are more or less colours than vertices, or if one is NaN.
inline void write_mesh(const std::filesystem::path& path, const triangle_mesh& mesh, std::span<const rgb> colours) {
  if (detail::mesh_format_of(path) != detail::mesh_format::ply)
    detail::refuse_file(path, "an OBJ file holds no colours of vertices, expected .ply");
  detail::check_mesh(mesh, path);
  if (colours.size() != static_cast<std::size_t>(mesh.vertices.cols()))
    detail::refuse_file(path, std::to_string(colours.size()) + " colours were given for " +
                                  std::to_string(mesh.vertices.cols()) + " vertices");
  const auto bad = std::ranges::find_if(colours, [](const rgb& colour) { return colour.isNaN().any(); });
  if (bad != colours.end())
    detail::refuse_file(path, "the colour of vertex " + std::to_string(bad - colours.begin()) + " is not a number");
  detail::write_ply(path, mesh, colours);
}

}  // namespace gonio::io
