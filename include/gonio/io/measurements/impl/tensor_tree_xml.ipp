#pragma once
/// Bodies of io/measurements/tensor_tree_xml.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/klems_xml.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/measurements/tensor_tree_xml.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/io/text/xml_element.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// A cube of directions: the corner with the smallest coordinates, and the length of its edges.
struct tree_cell {
  std::array<double, 4> corner{};
  double size = 1.0;
};

/// Returns the direction whose x and y are the image of a point of the unit square under Shirley and Chiu's map.
[[nodiscard]] GONIO_INLINE direction direction_of_square(double u, double v) {
  const double a = 2.0 * u - 1.0, b = 2.0 * v - 1.0;
  const bool is_along_a = std::abs(a) > std::abs(b);
  const double radius = is_along_a ? a : b;
  constexpr double eighth = std::numbers::pi / 4.0;
  const double angle = radius == 0.0 ? 0.0 : is_along_a ? eighth * b / a : eighth * (2.0 - a / b);
  const double x = radius * std::cos(angle), y = radius * std::sin(angle);
  return {x, y, std::sqrt(std::max(0.0, 1.0 - x * x - y * y))};
}

/// Reads the tree of a block: nodes in braces, each with 2^rank nodes or the values of a grid.
class tensor_tree_reader {
 public:
  tensor_tree_reader(const xml_element& data, std::size_t rank)
      : data_(data), rest_(data.content()), children_(std::size_t{1} << rank), rank_(rank) {}

  [[nodiscard]] sample_collector read();

 private:
  /// Deeper trees would separate directions less than a thousandth of a degree apart.
  static constexpr int most_levels = 16;

  [[nodiscard]] bool read_if(char c);
  void expect(char c);
  void read_node(const tree_cell& cell, int level);
  void read_grid(const tree_cell& cell);
  void add_cells(const tree_cell& cell, const std::vector<double>& values, std::size_t along_axis);
  void add_cell(const tree_cell& cell, double value);
  void add_centre(const tree_cell& cell, double value);
  [[noreturn]] void refuse(std::initializer_list<message_part> what) const { data_.position(rest_).refuse(what); }

  const xml_element& data_;
  std::string_view rest_;
  std::size_t children_, rank_;
  sample_collector collector_;
};

GONIO_INLINE sample_collector tensor_tree_reader::read() {
  read_node({}, 0);
  rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n,"), rest_.size()));
  if (!rest_.empty()) refuse({in_quotes(rest_.substr(0, 1)), " follows the tree"});
  return std::move(collector_);
}

/// Skips blanks and commas; takes the next character from the front of the text if it is `c`.
GONIO_INLINE bool tensor_tree_reader::read_if(char c) {
  rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n,"), rest_.size()));
  if (!rest_.starts_with(c)) return false;
  rest_.remove_prefix(1);
  return true;
}

GONIO_INLINE void tensor_tree_reader::expect(char c) {
  if (!read_if(c))
    refuse({rest_.empty() ? "the tree ends" : in_quotes(rest_.substr(0, 1)), ", expected ", std::string_view(&c, 1)});
}

GONIO_INLINE void tensor_tree_reader::read_node(const tree_cell& cell, int level) {
  expect('{');
  if (!read_if('{')) return read_grid(cell);
  if (level == most_levels) refuse({"the tree has more than ", most_levels, " levels"});
  rest_ = {rest_.data() - 1, rest_.size() + 1};  // the child reads its own brace
  for (std::size_t child = 0; child < children_; ++child) {
    tree_cell part{cell.corner, 0.5 * cell.size};
    for (std::size_t axis = 0; axis < rank_; ++axis)
      if ((child >> axis & 1U) != 0) part.corner[axis] += part.size;
    read_node(part, level + 1);
  }
  expect('}');
}

/// Reads a grid with equally many values along each axis, the last axis fastest. Its opening brace has been read.
GONIO_INLINE void tensor_tree_reader::read_grid(const tree_cell& cell) {
  std::vector<double> values;
  while (!read_if('}')) {
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n,{}"));
    values.push_back(scattering_value(data_, word));
    rest_.remove_prefix(word.size());
  }
  std::size_t along_axis = 1;
  const auto count = [&] {
    std::size_t all = 1;
    for (std::size_t axis = 0; axis < rank_; ++axis) all *= along_axis;
    return all;
  };
  while (count() < values.size()) along_axis *= 2;
  if (count() != values.size())
    refuse({"a node has ", values.size(), values.size() == 1 ? " value" : " values", ", expected 1, ", children_, ", ",
            children_ * children_, " or a power of two along each of ", rank_, " axes"});
  add_cells(cell, values, along_axis);
}

GONIO_INLINE void tensor_tree_reader::add_cells(const tree_cell& cell, const std::vector<double>& values,
                                                std::size_t along_axis) {
  const double size = cell.size / static_cast<double>(along_axis);
  for (std::size_t i = 0; i < values.size(); ++i) {
    tree_cell part{cell.corner, size};
    std::size_t left = i;
    for (std::size_t axis = rank_; axis-- > 0; left /= along_axis)
      part.corner[axis] += size * static_cast<double>(left % along_axis);
    add_cell(part, values[i]);
  }
}

/// Adds a cell; divides it if it is wider than an eighth of the cube.
GONIO_INLINE void tensor_tree_reader::add_cell(const tree_cell& cell, double value) {
  constexpr double widest = 1.0 / 8.0;
  const auto along_axis = static_cast<std::size_t>(std::max(1.0, cell.size / widest));
  std::size_t count = 1;
  for (std::size_t axis = 0; axis < rank_; ++axis) count *= along_axis;
  if (count == 1) return add_centre(cell, value);
  add_cells(cell, std::vector<double>(count, value), along_axis);
}

/// Adds a sample at the cell's centre. In trees of rank 3 the first axis goes from grazing light (0) to the normal
/// (0.5); cells above 0.5 are empty.
GONIO_INLINE void tensor_tree_reader::add_centre(const tree_cell& cell, double value) {
  std::array<double, 4> centre = cell.corner;
  for (double& coordinate : centre) coordinate += 0.5 * cell.size;
  if (rank_ == 4) {
    const direction opposite = direction_of_square(centre[0], centre[1]);
    collector_.add({{-opposite.x(), -opposite.y(), opposite.z()}, direction_of_square(centre[2], centre[3])},
                   {&value, 1});
    return;
  }
  if (centre[0] > 0.5) return;
  const double sine = 1.0 - 2.0 * centre[0];
  collector_.add({{-sine, 0.0, std::sqrt(1.0 - sine * sine)}, direction_of_square(centre[1], centre[2])}, {&value, 1});
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE bool looks_like_tensor_tree_xml(std::string_view text) {
  return looks_like_klems_xml(text) && text.find(">TensorTree") != std::string_view::npos;
}

GONIO_INLINE sample_set read_tensor_tree_xml(std::string_view text, const std::string& name,
                                             const window_block& wanted) {
  const detail::xml_element file(text, name), definition = file.first("DataDefinition");
  const std::string_view structure = definition.text("IncidentDataStructure");
  if (structure != "TensorTree3" && structure != "TensorTree4")
    definition.position(definition.content())
        .refuse(
            {"<IncidentDataStructure> ", in_quotes(structure), " is not a tree, expected TensorTree3 or TensorTree4"});
  const detail::xml_element block = detail::reflection_of(file, name, wanted), data = block.first("ScatteringData");
  if (const std::string_view basis = block.text("AngleBasis"); basis != "LBNL/Shirley-Chiu")
    block.position(block.content())
        .refuse({"<AngleBasis> ", in_quotes(basis), " is not supported, expected LBNL/Shirley-Chiu"});
  return detail::tensor_tree_reader(data, structure == "TensorTree3" ? 3 : 4).read().samples(name);
}

GONIO_INLINE sample_set read_tensor_tree_xml(const std::filesystem::path& path, const window_block& wanted) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_tensor_tree_xml(as_text(bytes), path.string(), wanted);
}

}  // namespace gonio::io
