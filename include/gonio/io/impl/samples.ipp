#pragma once
/// Bodies of io/samples.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/samples.hpp>
#include <gonio/io/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (std::size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',')) {
    fields.push_back(trimmed(line.substr(0, comma)));
    line.remove_prefix(comma + 1);
  }
  fields.push_back(trimmed(line));
}

GONIO_INLINE sample_header::sample_header(std::string_view line, bool needs_colour, const text_place& place) {
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  for (const std::string_view field : fields) add(field, place);
  find_directions(place);
  if (needs_colour || has_any(colour_group)) require(colour_group, place);
}

GONIO_INLINE void sample_header::add(std::string_view field, const text_place& place) {
  const auto found = std::ranges::find(sample_columns, field);
  if (found == sample_columns.end())
    place.refuse("column " + quoted(field) + " is unknown, expected theta_h,theta_d,phi_d or " +
                 "theta_i,phi_i,theta_o,phi_o or wi_x,wi_y,wi_z,wo_x,wo_y,wo_z, and r,g,b and perhaps weight");
  const auto column = static_cast<std::size_t>(found - sample_columns.begin());
  if (has(column)) place.refuse("column " + quoted(field) + " appears twice");
  columns_.push_back(column);
}

GONIO_INLINE void sample_header::find_directions(const text_place& place) {
  int groups = 0;
  for (const column_group& group : {half_difference_group, angle_group, vector_group}) {
    if (!has_any(group)) continue;
    directions_ = group;
    ++groups;
  }
  if (groups == 0)
    place.refuse("there are no columns of directions, expected theta_h,theta_d,phi_d or " +
                 std::string("theta_i,phi_i,theta_o,phi_o or wi_x,wi_y,wi_z,wo_x,wo_y,wo_z"));
  if (groups > 1) place.refuse("directions are given in more than one way, expected one of them");
  require(directions_, place);
}

GONIO_INLINE bool sample_header::has_any(const column_group& group) const {
  return std::ranges::any_of(columns_,
                             [&](std::size_t c) { return c >= group.first && c < group.first + group.count; });
}

GONIO_INLINE void sample_header::require(const column_group& group, const text_place& place) const {
  for (std::size_t column = group.first; column < group.first + group.count; ++column)
    if (!has(column)) place.refuse("column '" + std::string(sample_columns[column]) + "' is missing");
}

GONIO_INLINE double polar_angle(const sample_row& row, std::size_t column, bool either_side, const text_place& place) {
  const double angle = row[column];
  if (!((angle >= 0.0 || either_side) && std::abs(angle) < 90.0))
    place.refuse("column " + std::string(sample_columns[column]) + ": " + shortest(angle) + " degrees" +
                 (angle < 0.0 && !either_side ? " is negative" : " is at or below the horizon") + ", expected " +
                 (either_side ? "between -90 and 90" : "at least 0 and less than 90"));
  return radians(angle);
}

GONIO_INLINE double azimuth(const sample_row& row, std::size_t column, const text_place& place) {
  if (!(std::abs(row[column]) <= 360.0))
    place.refuse("column " + std::string(sample_columns[column]) + ": " + shortest(row[column]) +
                 " degrees, expected from -360 to 360");
  return radians(row[column]);
}

GONIO_INLINE direction unit_vector(const sample_row& row, std::size_t first, const text_place& place) {
  const direction given(row[first], row[first + 1], row[first + 2]);
  const std::string columns =
      "columns " + std::string(sample_columns[first]) + " to " + std::string(sample_columns[first + 2]);
  const double length = given.norm();
  if (!(std::abs(length - 1.0) <= 1e-3))
    place.refuse(columns + ": the vector has length " + shortest(length) + ", expected 1");
  if (!(given.z() > 0.0))
    place.refuse(columns + ": the direction is at or below the horizon, its z is " + shortest(given.z()));
  return given / length;
}

GONIO_INLINE void require_above_horizon(const cosine_pair& cosine, const parsed_row& row) {
  if (cosine.i > 0.0 && cosine.o > 0.0) return;
  std::string given;
  for (std::size_t column = row.group.first; column < row.group.first + row.group.count; ++column)
    given += (given.empty() ? "" : ", ") + std::string(sample_columns[column]) + " " + shortest(row.numbers[column]);
  row.place.refuse("a direction is at or below the horizon (" + given + ")");
}

GONIO_INLINE half_difference given_angles(const parsed_row& row) {
  return {polar_angle(row.numbers, 0, false, row.place), polar_angle(row.numbers, 1, false, row.place),
          azimuth(row.numbers, 2, row.place)};
}

GONIO_INLINE direction_pair given_directions(const parsed_row& row) {
  const auto& [numbers, group, place] = row;
  if (group.first == vector_group.first) return {unit_vector(numbers, 7, place), unit_vector(numbers, 10, place)};
  const double theta_i = polar_angle(numbers, 3, true, place), theta_o = polar_angle(numbers, 5, true, place);
  return {spherical_direction(theta_i, azimuth(numbers, 4, place)),
          spherical_direction(theta_o, azimuth(numbers, 6, place))};
}

GONIO_INLINE half_difference row_angles(const parsed_row& row) {
  half_difference angles;
  if (row.has_half_difference()) {
    angles = given_angles(row);
    angles.phi_d = fold_phi_d(angles.phi_d);
  } else {
    const direction_pair pair = given_directions(row);
    angles = to_half_difference(pair.wi, pair.wo);
  }
  require_above_horizon(cosines(angles), row);
  return angles;
}

GONIO_INLINE direction_pair row_directions(const parsed_row& row) {
  const direction_pair pair = row.has_half_difference() ? to_directions(given_angles(row)) : given_directions(row);
  require_above_horizon({pair.wi.z(), pair.wo.z()}, row);
  return pair;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE sample_set parse_samples(std::string_view text, const std::string& name) {
  sample_set samples;
  detail::parse_rows(text, name, true, [&](const detail::parsed_row& row) {
    constexpr std::size_t colour = detail::colour_group.first;
    const detail::sample_row& numbers = row.numbers;
    samples.push_back({detail::row_angles(row),
                       {numbers[colour], numbers[colour + 1], numbers[colour + 2]},
                       numbers[detail::weight_column]});
  });
  return samples;
}

GONIO_INLINE sample_set read_samples(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  return parse_samples(detail::as_text(bytes), path.string());
}

GONIO_INLINE void write_direction_pairs(const std::filesystem::path& path, std::span<const direction_pair> pairs) {
  const auto rounded = [](double angle) { return detail::shortest(std::round(degrees(angle) * 1e9) / 1e9 + 0.0); };
  std::string text = "theta_i,phi_i,theta_o,phi_o\n";
  for (const auto& [wi, wo] : pairs)
    text += rounded(gonio::polar_angle(wi)) + ',' + rounded(gonio::azimuth(wi)) + ',' +
            rounded(gonio::polar_angle(wo)) + ',' + rounded(gonio::azimuth(wo)) + '\n';
  write_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace gonio::io
