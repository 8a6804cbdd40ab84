#pragma once
/// Bodies of io/samples.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/io/file.hpp>
#include <gonio/io/samples.hpp>
#include <gonio/io/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

// The columns, grouped; the numbers below index this list.
inline constexpr std::array<std::string_view, 20> sample_columns{
    "theta_h", "theta_d", "phi_d", "theta_i", "phi_i", "theta_o", "phi_o",  "wi_x",     "wi_y",     "wi_z",
    "wo_x",    "wo_y",    "wo_z",  "r",       "g",     "b",       "weight", "weight_r", "weight_g", "weight_b"};

struct column_group {
  std::size_t first = 0;
  std::size_t count = 0;
};
inline constexpr column_group half_difference_group{0, 3};
inline constexpr column_group angle_group{3, 4};
inline constexpr column_group vector_group{7, 6};
inline constexpr column_group colour_group{13, 3};
inline constexpr column_group weight_group{16, 1};
inline constexpr column_group channel_weight_group{17, 3};

using sample_row = std::array<double, sample_columns.size()>;

/// The header line: which column each field of a line is, and how directions are given.
class sample_header {
 public:
  void read(std::string_view line, bool needs_colour, const text_place& place);

  [[nodiscard]] const std::vector<std::size_t>& columns() const noexcept { return columns_; }
  [[nodiscard]] const column_group& directions() const noexcept { return directions_; }
  /// The columns that say how much a sample counts: one, or one for each channel.
  [[nodiscard]] column_group weights() const {
    return has_any(channel_weight_group) ? channel_weight_group : weight_group;
  }

 private:
  void add(std::string_view field, const text_place& place);
  void find_directions(const text_place& place);
  [[nodiscard]] bool has_any(const column_group& group) const;
  [[nodiscard]] bool has(std::size_t column) const { return has_any({column, 1}); }
  void require(const column_group& group, const text_place& place) const;

  std::vector<std::size_t> columns_;
  column_group directions_;
};

GONIO_INLINE void sample_header::read(std::string_view line, bool needs_colour, const text_place& place) {
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  for (const std::string_view field : fields) add(field, place);
  find_directions(place);
  if (needs_colour || has_any(colour_group)) require(colour_group, place);
  if (!has_any(channel_weight_group)) return;
  if (has_any(weight_group))
    place.refuse("weights are given in two ways, expected weight or weight_r,weight_g,weight_b");
  require(channel_weight_group, place);
}

GONIO_INLINE void sample_header::add(std::string_view field, const text_place& place) {
  std::size_t column = 0;
  while (column < sample_columns.size() && sample_columns[column] != field) ++column;
  if (column == sample_columns.size())
    place.refuse({"column ", quoted(field), " is unknown, expected theta_h,theta_d,phi_d or ",
                  "theta_i,phi_i,theta_o,phi_o or wi_x,wi_y,wi_z,wo_x,wo_y,wo_z, and r,g,b and perhaps weight or "
                  "weight_r,weight_g,weight_b"});
  if (has(column)) place.refuse({"column ", quoted(field), " appears twice"});
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
    place.refuse({"there are no columns of directions, expected theta_h,theta_d,phi_d or ",
                  "theta_i,phi_i,theta_o,phi_o or wi_x,wi_y,wi_z,wo_x,wo_y,wo_z"});
  if (groups > 1) place.refuse("directions are given in more than one way, expected one of them");
  require(directions_, place);
}

GONIO_INLINE bool sample_header::has_any(const column_group& group) const {
  for (const std::size_t column : columns_)
    if (column >= group.first && column < group.first + group.count) return true;
  return false;
}

GONIO_INLINE void sample_header::require(const column_group& group, const text_place& place) const {
  for (std::size_t column = group.first; column < group.first + group.count; ++column)
    if (!has(column)) place.refuse({"column '", sample_columns[column], "' is missing"});
}

/// A line of numbers, in its place.
struct parsed_row {
  const sample_row& numbers;
  const column_group& group;   ///< how directions are given
  const column_group weights;  ///< how weights are given
  const text_place& place;

  [[nodiscard]] bool has_half_difference() const noexcept { return group.first == half_difference_group.first; }
};

/// Reads a file of samples or directions line by line:
/// `row_reader rows(text, name, false); while (rows.next()) use(rows.row());`
class row_reader {
 public:
  row_reader(std::string_view text, const std::string& name, bool needs_colour)
      : left_(without_byte_order_mark(text)), place_{name, 0}, needs_colour_(needs_colour) {
    numbers_[weight_group.first] = 1.0;
  }

  /// Turns to the next line of numbers. At the end of the file it is false, or an error if there was none.
  [[nodiscard]] bool next();

  [[nodiscard]] parsed_row row() const noexcept { return {numbers_, header_.directions(), header_.weights(), place_}; }

 private:
  void read_numbers(std::string_view line);

  std::string_view left_;
  text_place place_;
  bool needs_colour_;
  sample_header header_;
  std::vector<std::string_view> fields_;
  sample_row numbers_{};
  std::size_t rows_ = 0;
};

GONIO_INLINE bool row_reader::next() {
  std::string_view line;
  if (header_.columns().empty()) {
    if (!next_line(left_, place_, line))
      gonio::refuse({place_.name, ": is empty, expected a header line that names the columns"});
    header_.read(line, needs_colour_, place_);
  }
  if (next_line(left_, place_, line)) {
    read_numbers(line);
    ++rows_;
    return true;
  }
  if (rows_ == 0) gonio::refuse({place_.name, ": has a header line but no samples, expected at least one"});
  return false;
}

GONIO_INLINE void row_reader::read_numbers(std::string_view line) {
  const std::vector<std::size_t>& columns = header_.columns();
  split_fields(line, fields_);
  if (fields_.size() != columns.size())
    place_.refuse({fields_.size(), " fields, expected ", columns.size(), " as in the header line"});
  for (std::size_t i = 0; i < fields_.size(); ++i)
    if (const char* wrong = read_number(fields_[i], numbers_[columns[i]]))
      place_.refuse({"column ", sample_columns[columns[i]], ": ", quoted(fields_[i]), wrong});
  const column_group weights = header_.weights();
  for (std::size_t column = weights.first; column < weights.first + weights.count; ++column)
    if (numbers_[column] < 0.0)
      place_.refuse(
          {"column ", sample_columns[column], ": ", shortest(numbers_[column]), " is negative, expected at least 0"});
}

/// A polar angle in radians. A goniometer's arm may lean to either side: there a negative angle is as good
/// as an azimuth of 180 degrees.
[[nodiscard]] GONIO_INLINE double polar_angle(const sample_row& row, std::size_t column, bool either_side,
                                              const text_place& place) {
  const double angle = row[column];
  if (!((angle >= 0.0 || either_side) && std::abs(angle) < 90.0))
    place.refuse({"column ", sample_columns[column], ": ", shortest(angle), " degrees",
                  angle < 0.0 && !either_side ? " is negative" : " is at or below the horizon", ", expected ",
                  either_side ? "between -90 and 90" : "at least 0 and less than 90"});
  return radians(angle);
}

[[nodiscard]] GONIO_INLINE double azimuth(const sample_row& row, std::size_t column, const text_place& place) {
  if (!(std::abs(row[column]) <= 360.0))
    place.refuse(
        {"column ", sample_columns[column], ": ", shortest(row[column]), " degrees, expected from -360 to 360"});
  return radians(row[column]);
}

[[nodiscard]] GONIO_INLINE direction unit_vector(const sample_row& row, std::size_t first, const text_place& place) {
  const double x = row[first], y = row[first + 1], z = row[first + 2];
  const double length = gonio::detail::norm_of(x, y, z);
  const auto refuse = [&](const char* what, double value, const char* expected) {
    place.refuse(
        {"columns ", sample_columns[first], " to ", sample_columns[first + 2], what, shortest(value), expected});
  };
  if (!(std::abs(length - 1.0) <= 1e-3)) refuse(": the vector has length ", length, ", expected 1");
  if (!(z > 0.0)) refuse(": the direction is at or below the horizon, its z is ", z, "");
  return {x / length, y / length, z / length};
}

GONIO_INLINE void require_above_horizon(const cosine_pair& cosine, const parsed_row& row) {
  if (cosine.i > 0.0 && cosine.o > 0.0) return;
  std::string given;
  for (std::size_t column = row.group.first; column < row.group.first + row.group.count; ++column)
    given += message_of({given.empty() ? "" : ", ", sample_columns[column], " ", shortest(row.numbers[column])});
  row.place.refuse({"a direction is at or below the horizon (", given, ")"});
}

/// Of a row that gives half and difference angles.
[[nodiscard]] GONIO_INLINE half_difference given_angles(const parsed_row& row) {
  return {polar_angle(row.numbers, 0, false, row.place), polar_angle(row.numbers, 1, false, row.place),
          azimuth(row.numbers, 2, row.place)};
}

/// Light and viewer of a row that gives directions.
[[nodiscard]] GONIO_INLINE direction_pair given_directions(const parsed_row& row) {
  const auto& [numbers, group, weights, place] = row;
  if (group.first == vector_group.first) return {unit_vector(numbers, 7, place), unit_vector(numbers, 10, place)};
  const double theta_i = polar_angle(numbers, 3, true, place), theta_o = polar_angle(numbers, 5, true, place);
  return {spherical_direction(theta_i, azimuth(numbers, 4, place)),
          spherical_direction(theta_o, azimuth(numbers, 6, place))};
}

/// Angles as they were given. Those of phi_d beyond half a turn exchange light and viewer: they are kept as a pair.
[[nodiscard]] GONIO_INLINE sample_directions directions_of(const half_difference& given) {
  if (fold_phi_d(given.phi_d) == given.phi_d) return given;
  return to_directions(given);
}

/// A row's directions. Rounding may put one that grazes the surface below it in one of the two ways alone; it is
/// refused in both.
[[nodiscard]] GONIO_INLINE sample_directions row_directions(const parsed_row& row) {
  const sample_directions at = row.has_half_difference() ? directions_of(given_angles(row)) : given_directions(row);
  require_above_horizon(cosines(at.angles()), row);
  require_above_horizon({at.pair().wi.z(), at.pair().wo.z()}, row);
  return at;
}

[[nodiscard]] GONIO_INLINE channel_weights row_weight(const parsed_row& row) {
  const double* first = &row.numbers[row.weights.first];
  return row.weights.count == 1 ? channel_weights(first[0]) : channel_weights(rgb(first[0], first[1], first[2]));
}

[[nodiscard]] GONIO_INLINE rgb row_value(const parsed_row& row) {
  const double* colour = &row.numbers[colour_group.first];
  for (std::size_t channel = 0; channel < 3; ++channel)
    if (std::abs(colour[channel]) > double{std::numeric_limits<float>::max()})
      row.place.refuse({"column ", sample_columns[colour_group.first + channel], ": ", shortest(colour[channel]),
                        " sr^-1 is beyond the range of float"});
  return {colour[0], colour[1], colour[2]};
}

GONIO_INLINE void format_sample(std::string& text, const sample& s, bool weighs_channels_apart) {
  const half_difference& at = s.angles();
  for (const double value : {degrees(at.theta_h), degrees(at.theta_d), degrees(fold_phi_d(at.phi_d)), s.value.x(),
                             s.value.y(), s.value.z()}) {
    text += shortest(value);
    text += ',';
  }
  text += shortest(s.weight[0]);
  for (Eigen::Index channel = 1; weighs_channels_apart && channel < 3; ++channel) {
    text += ',';
    text += shortest(s.weight[channel]);
  }
  text += '\n';
}

GONIO_INLINE void write_text(const std::filesystem::path& path, std::string_view text) {
  write_atomically(path, {reinterpret_cast<const std::byte*>(text.data()), text.size()});
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE sample_set parse_samples(std::string_view text, const std::string& name) {
  sample_set samples;
  detail::row_reader rows(text, name, true);
  while (rows.next()) {
    const detail::parsed_row row = rows.row();
    samples.push_back({detail::row_directions(row), detail::row_value(row), detail::row_weight(row)});
  }
  return samples;
}

GONIO_INLINE sample_set read_samples(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  return parse_samples(detail::as_text(bytes), path.native());
}

GONIO_INLINE std::vector<half_difference> read_directions(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  detail::row_reader rows(detail::as_text(bytes), path.native(), false);
  std::vector<half_difference> all;
  while (rows.next()) all.push_back(detail::row_directions(rows.row()).angles());
  return all;
}

GONIO_INLINE std::vector<direction_pair> read_direction_pairs(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  detail::row_reader rows(detail::as_text(bytes), path.native(), false);
  std::vector<direction_pair> all;
  while (rows.next()) all.push_back(detail::row_directions(rows.row()).pair());
  return all;
}

GONIO_INLINE void write_direction_pairs(const std::filesystem::path& path, std::span<const direction_pair> pairs) {
  const auto rounded = [](double angle) { return detail::shortest(std::round(degrees(angle) * 1e9) / 1e9 + 0.0); };
  std::string text = "theta_i,phi_i,theta_o,phi_o\n";
  for (const auto& [wi, wo] : pairs)
    text += message_of({rounded(gonio::polar_angle(wi)), ",", rounded(gonio::azimuth(wi)), ",",
                        rounded(gonio::polar_angle(wo)), ",", rounded(gonio::azimuth(wo)), "\n"});
  detail::write_text(path, text);
}

}  // namespace gonio::io
