#pragma once
/// Bodies of io/measurements/sample_layout.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/measurements/sample_columns.hpp>
#include <gonio/io/measurements/sample_layout.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace gonio::io::detail {

inline constexpr std::size_t column_theta_i = angle_group.first, column_theta_o = angle_group.first + 2;

/// Reads degrees, with or without a degree sign. The file's decimal mark is not known yet.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::optional<double> degrees_in(std::string_view field) {
  std::string digits(without_degree_sign(trimmed(field)));
  std::ranges::replace(digits, ',', '.');
  double angle = 0.0;
  if (read_number(digits, angle) != nullptr || !(std::abs(angle) <= 360.0)) return {};
  return angle;
}

[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::size_t other_polar_angle(std::size_t column) {
  return column == column_theta_i ? column_theta_o : column_theta_i;
}

/// Returns the matrix that the first field of its header line describes, still without the angles of the other fields.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::optional<sample_matrix> corner_of(std::string_view field,
                                                                                const column_finder& find_column) {
  const std::size_t between = field.find_first_of("\\/|");
  const std::string_view down_name = trimmed(field.substr(0, between));
  if (down_name.ends_with(':') || down_name.ends_with('=')) return {};  // a line that states an angle
  if (unit_named(written(down_name).unit) == column_unit::radians) return {};
  const std::size_t down = find_column(down_name);
  if (down != column_theta_i && down != column_theta_o) return {};
  const std::size_t across = other_polar_angle(down);
  if (between != std::string_view::npos && find_column(trimmed(field.substr(between + 1))) != across) return {};
  return sample_matrix{.down = down, .across = across};
}

/// Reads an angle from a field of the header line: a number, or a name and a number.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::optional<double> angle_across(std::string_view field, std::size_t across,
                                                                            const column_finder& find_column) {
  if (const auto angle = degrees_in(field)) return angle;
  field = without_degree_sign(field);
  const std::size_t last = field.find_last_of("= :");
  if (last == std::string_view::npos) return {};
  const std::size_t name_end = field.find_last_not_of("= :", last);
  if (name_end == std::string_view::npos || find_column(field.substr(0, name_end + 1)) != across) return {};
  return degrees_in(field.substr(last + 1));
}

[[gnu::cold]] GONIO_INLINE std::optional<sample_matrix> matrix_of(std::span<const std::string_view> fields,
                                                                  const column_finder& find_column) {
  if (fields.size() < 2) return {};
  std::optional<sample_matrix> matrix = corner_of(fields.front(), find_column);
  if (!matrix) return {};
  for (const std::string_view field : fields.subspan(1)) {
    const auto angle = angle_across(field, matrix->across, find_column);
    if (!angle || std::abs(*angle) > 90.0) return {};
    matrix->angles.push_back(*angle);
  }
  return matrix;
}

[[gnu::cold]] GONIO_INLINE std::string description(const sample_matrix& matrix) {
  constexpr std::size_t most = 6;
  const std::size_t count = matrix.angles.size();
  std::string angles;
  for (std::size_t i = 0; i < std::min(most, count); ++i)
    angles += message_of({i == 0 ? "" : ", ", shortest(matrix.angles[i])});
  const std::string more = count > most ? message_of({" and ", count - most, " more"}) : "";
  return message_of(
      {sample_columns[matrix.down], " down, ", sample_columns[matrix.across], " across: ", angles, more, " degrees"});
}

[[gnu::cold]] GONIO_INLINE std::optional<stated_angle> stated_angle_of(std::string_view line,
                                                                       const column_finder& find_column) {
  constexpr std::string_view separators = ":=;,\t";
  const std::size_t end = line.find_first_of(separators);
  if (end == std::string_view::npos) return {};
  const std::size_t column = find_column(trimmed(line.substr(0, end)));
  if (!angle_group.has(column) || unit_named(written(line.substr(0, end)).unit) == column_unit::radians) return {};
  std::string_view value = line.substr(std::min(line.find_first_not_of(" :=;,\t", end), line.size()));
  // Drop separators added by a spreadsheet; keep a decimal comma.
  value = value.substr(0, value.find_first_of(";\t"));
  while (!value.empty() && (value.back() == ',' || value.back() == '"' || value.back() == ' ')) value.remove_suffix(1);
  const auto angle = degrees_in(value);
  if (!angle) return {};
  return stated_angle{column, *angle};
}

}  // namespace gonio::io::detail
