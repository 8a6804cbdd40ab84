#pragma once
/// Bodies of shape/io/pose.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/rotation.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/setups/setup_text.hpp>
#include <gonio/io/text/rules.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/io/pose.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

using pose_matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

/// Reads four lines of numbers.
[[nodiscard]] GONIO_INLINE pose_matrix read_matrix(std::string_view text, const std::string& name) {
  text_position position{name};
  std::vector<double> numbers;
  for_each_line(text, position, [&](std::string_view line) {
    const std::string named = "matrix " + std::string(line);
    const text_rule row = read_rule(named, position);
    require_numbers(row, {4}, position);
    numbers.insert(numbers.end(), row.numbers.begin(), row.numbers.end());
  });
  if (numbers.size() != 16) gonio::refuse({name, ": has ", numbers.size() / 4, " lines of numbers, expected 4"});
  const pose_matrix matrix = pose_matrix::Map(numbers.data());
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0))
    position.refuse("the last line of a pose's matrix must be 0 0 0 1");
  return matrix;
}

/// Reads a rotation and a translation.
[[nodiscard]] GONIO_INLINE pose_matrix read_parts(std::string_view text, const std::string& name) {
  static constexpr std::array<setup_entry, 2> entries{{{"rotation", 9}, {"translation", 3}}};
  const setup_text parts(text, name, entries);
  pose_matrix matrix = pose_matrix::Identity();
  matrix.topLeftCorner<3, 3>() = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>::Map(parts.numbers("rotation").data());
  matrix.topRightCorner<3, 1>() = parts.vector("translation");
  return matrix;
}

/// Returns whether a text names its entries.
[[nodiscard]] GONIO_INLINE bool has_names(std::string_view text) {
  text_position position{};
  std::string_view line;
  text = without_byte_order_mark(text);
  if (!next_line(text, position, line)) return false;
  return (line.front() >= 'a' && line.front() <= 'z') || (line.front() >= 'A' && line.front() <= 'Z');
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE shape::similarity_transform read_pose(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  const std::string_view text = as_text(bytes);
  const std::string name = path.string();
  const detail::pose_matrix matrix =
      detail::has_names(text) ? detail::read_parts(text, name) : detail::read_matrix(text, name);
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  if (!is_rotation(rotation))
    gonio::refuse({name, ": is not a rigid motion: its rotation scales, shears or mirrors by more than 0.001"});
  return {1.0, Eigen::Quaterniond(rotation).normalized().toRotationMatrix(), matrix.topRightCorner<3, 1>()};
}

GONIO_INLINE void write_pose(const std::filesystem::path& path, const shape::similarity_transform& pose) {
  std::string text;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) text += shortest(pose.scale * pose.rotation(row, column)) + ' ';
    text += shortest(pose.translation[row]) + '\n';
  }
  text += "0 0 0 1\n";
  write_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace gonio::io
