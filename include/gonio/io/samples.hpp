#pragma once
/// Measurements as CSV: a header line names the columns, in any order; each further line is a sample.
/// Directions are `theta_h,theta_d,phi_d` or `theta_i,phi_i,theta_o,phi_o` in degrees, or unit vectors
/// `wi_x,wi_y,wi_z,wo_x,wo_y,wo_z` (normal +z); the reflectance is `r,g,b` in sr^-1 without the cosine; a
/// `weight` is optional. Empty lines and lines that start with # are skipped.

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

namespace gonio::io {

namespace detail {

// The columns, grouped; the numbers below index this list.
inline constexpr std::array<std::string_view, 17> sample_columns{
    "theta_h", "theta_d", "phi_d", "theta_i", "phi_i", "theta_o", "phi_o", "wi_x",  "wi_y",
    "wi_z",    "wo_x",    "wo_y",  "wo_z",    "r",     "g",       "b",     "weight"};

struct column_group {
  std::size_t first = 0;
  std::size_t count = 0;
};
inline constexpr column_group half_difference_group{0, 3};
inline constexpr column_group angle_group{3, 4};
inline constexpr column_group vector_group{7, 6};
inline constexpr column_group colour_group{13, 3};
inline constexpr std::size_t weight_column = 16;

using sample_row = std::array<double, sample_columns.size()>;

inline void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (std::size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',')) {
    fields.push_back(trimmed(line.substr(0, comma)));
    line.remove_prefix(comma + 1);
  }
  fields.push_back(trimmed(line));
}

/// The header line: which column each field of a line is, and how directions are given.
class sample_header {
 public:
  sample_header(std::string_view line, bool needs_colour, const text_place& place) {
    std::vector<std::string_view> fields;
    split_fields(line, fields);
    for (const std::string_view field : fields) add(field, place);
    find_directions(place);
    if (needs_colour || has_any(colour_group)) require(colour_group, place);
  }

  [[nodiscard]] std::span<const std::size_t> columns() const noexcept { return columns_; }
  [[nodiscard]] const column_group& directions() const noexcept { return directions_; }

 private:
  void add(std::string_view field, const text_place& place) {
    const auto found = std::ranges::find(sample_columns, field);
    if (found == sample_columns.end())
      place.refuse("column " + quoted(field) + " is unknown, expected theta_h,theta_d,phi_d or " +
                   "theta_i,phi_i,theta_o,phi_o or wi_x,wi_y,wi_z,wo_x,wo_y,wo_z, and r,g,b and perhaps weight");
    const auto column = static_cast<std::size_t>(found - sample_columns.begin());
    if (has(column)) place.refuse("column " + quoted(field) + " appears twice");
    columns_.push_back(column);
  }

  void find_directions(const text_place& place) {
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

  [[nodiscard]] bool has(std::size_t column) const { return std::ranges::find(columns_, column) != columns_.end(); }
  [[nodiscard]] bool has_any(const column_group& group) const {
    return std::ranges::any_of(columns_,
                               [&](std::size_t c) { return c >= group.first && c < group.first + group.count; });
  }
  void require(const column_group& group, const text_place& place) const {
    for (std::size_t column = group.first; column < group.first + group.count; ++column)
      if (!has(column)) place.refuse("column '" + std::string(sample_columns[column]) + "' is missing");
  }

  std::vector<std::size_t> columns_;
  column_group directions_;
};

/// A polar angle in radians. A goniometer's arm may lean to either side: there a negative angle is as good
/// as an azimuth of 180 degrees.
[[nodiscard]] inline double polar_angle(const sample_row& row, std::size_t column, bool either_side,
                                        const text_place& place) {
  const double angle = row[column];
  if (!((angle >= 0.0 || either_side) && std::abs(angle) < 90.0))
    place.refuse("column " + std::string(sample_columns[column]) + ": " + shortest(angle) + " degrees" +
                 (angle < 0.0 && !either_side ? " is negative" : " is at or below the horizon") + ", expected " +
                 (either_side ? "between -90 and 90" : "at least 0 and less than 90"));
  return radians(angle);
}

[[nodiscard]] inline double azimuth(const sample_row& row, std::size_t column, const text_place& place) {
  if (!(std::abs(row[column]) <= 360.0))
    place.refuse("column " + std::string(sample_columns[column]) + ": " + shortest(row[column]) +
                 " degrees, expected from -360 to 360");
  return radians(row[column]);
}

[[nodiscard]] inline direction unit_vector(const sample_row& row, std::size_t first, const text_place& place) {
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

/// A line of numbers, in its place.
struct parsed_row {
  const sample_row& numbers;
  const column_group& group;  ///< how directions are given
  const text_place& place;

  [[nodiscard]] bool has_half_difference() const noexcept { return group.first == half_difference_group.first; }
};

inline void require_above_horizon(const cosine_pair& cosine, const parsed_row& row) {
  if (cosine.i > 0.0 && cosine.o > 0.0) return;
  std::string given;
  for (std::size_t column = row.group.first; column < row.group.first + row.group.count; ++column)
    given += (given.empty() ? "" : ", ") + std::string(sample_columns[column]) + " " + shortest(row.numbers[column]);
  row.place.refuse("a direction is at or below the horizon (" + given + ")");
}

/// Of a row that gives half and difference angles.
[[nodiscard]] inline half_difference given_angles(const parsed_row& row) {
  return {polar_angle(row.numbers, 0, false, row.place), polar_angle(row.numbers, 1, false, row.place),
          azimuth(row.numbers, 2, row.place)};
}

/// Light and viewer of a row that gives directions.
[[nodiscard]] inline direction_pair given_directions(const parsed_row& row) {
  const auto& [numbers, group, place] = row;
  if (group.first == vector_group.first) return {unit_vector(numbers, 7, place), unit_vector(numbers, 10, place)};
  const double theta_i = polar_angle(numbers, 3, true, place), theta_o = polar_angle(numbers, 5, true, place);
  return {spherical_direction(theta_i, azimuth(numbers, 4, place)),
          spherical_direction(theta_o, azimuth(numbers, 6, place))};
}

[[nodiscard]] inline half_difference row_angles(const parsed_row& row) {
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

[[nodiscard]] inline direction_pair row_directions(const parsed_row& row) {
  const direction_pair pair = row.has_half_difference() ? to_directions(given_angles(row)) : given_directions(row);
  require_above_horizon({pair.wi.z(), pair.wo.z()}, row);
  return pair;
}

/// Calls `use(row)` for each line of numbers.
template <class Use>
void parse_rows(std::string_view text, const std::string& name, bool needs_colour, Use&& use) {
  text_place place{name, 0};
  std::optional<sample_header> header;
  std::vector<std::string_view> fields;
  sample_row row{};
  row[weight_column] = 1.0;
  std::size_t rows = 0;
  for_each_line(text, place, [&](std::string_view line) {
    if (!header) {
      header.emplace(line, needs_colour, place);
      return;
    }
    split_fields(line, fields);
    if (fields.size() != header->columns().size())
      place.refuse(std::to_string(fields.size()) + " fields, expected " + std::to_string(header->columns().size()) +
                   " as in the header line");
    for (std::size_t i = 0; i < fields.size(); ++i)
      row[header->columns()[i]] =
          parse_number(fields[i], place, [&] { return "column " + std::string(sample_columns[header->columns()[i]]); });
    if (row[weight_column] < 0.0)
      place.refuse("column weight: " + shortest(row[weight_column]) + " is negative, expected at least 0");
    use(parsed_row{row, header->directions(), place});
    ++rows;
  });
  if (!header) throw error(name + ": is empty, expected a header line that names the columns");
  if (rows == 0) throw error(name + ": has a header line but no samples, expected at least one");
}

/// What `of` makes of each row of a file of directions.
template <class Of>
[[nodiscard]] auto read_rows(const std::filesystem::path& path, Of&& of) {
  const auto bytes = read_bytes(path);
  std::vector<decltype(of(std::declval<const parsed_row&>()))> all;
  parse_rows(as_text(bytes), path.string(), false, [&](const parsed_row& row) { all.push_back(of(row)); });
  return all;
}

}  // namespace detail

/// Samples from the text of a CSV file; `name` is what errors call it.
[[nodiscard]] inline sample_set parse_samples(std::string_view text, const std::string& name) {
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

/// Reads measurements. Throws gonio::error naming file, line, column and value of what is wrong.
[[nodiscard]] inline sample_set read_samples(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  return parse_samples(detail::as_text(bytes), path.string());
}

/// Reads directions alone; the file may have `r,g,b` and `weight` columns, which are checked and left out.
[[nodiscard]] inline std::vector<half_difference> read_directions(const std::filesystem::path& path) {
  return detail::read_rows(path, [](const detail::parsed_row& row) { return detail::row_angles(row); });
}

/// Reads the same files as pairs, in which light and viewer are told apart.
[[nodiscard]] inline std::vector<direction_pair> read_direction_pairs(const std::filesystem::path& path) {
  return detail::read_rows(path, [](const detail::parsed_row& row) { return detail::row_directions(row); });
}

/// Writes pairs as `theta_i,phi_i,theta_o,phi_o`, rounded to 1e-9 degrees.
inline void write_direction_pairs(const std::filesystem::path& path, std::span<const direction_pair> pairs) {
  const auto rounded = [](double angle) { return detail::shortest(std::round(degrees(angle) * 1e9) / 1e9 + 0.0); };
  std::string text = "theta_i,phi_i,theta_o,phi_o\n";
  for (const auto& [wi, wo] : pairs)
    text += rounded(gonio::polar_angle(wi)) + ',' + rounded(gonio::azimuth(wi)) + ',' +
            rounded(gonio::polar_angle(wo)) + ',' + rounded(gonio::azimuth(wo)) + '\n';
  write_atomically(path, std::as_bytes(std::span(text)));
}

/// Samples as CSV text, every number in the fewest digits that read back as the same number.
template <sample_range Samples>
[[nodiscard]] std::string format_samples(const Samples& samples) {
  std::string text = "theta_h,theta_d,phi_d,r,g,b,weight\n";
  for (auto&& each : samples) {
    const sample& s = each;
    const half_difference& at = s.angles;
    for (const double value : {degrees(at.theta_h), degrees(at.theta_d), degrees(fold_phi_d(at.phi_d)), s.value.x(),
                               s.value.y(), s.value.z()})
      text += detail::shortest(value) + ',';
    text += detail::shortest(s.weight) + '\n';
  }
  return text;
}

/// Writes measurements. Throws gonio::error if a sample is unusable, before anything is written.
template <sample_range Samples>
void write_samples(const std::filesystem::path& path, const Samples& samples) {
  try {
    require_usable(samples);
  } catch (const error& unusable) {
    throw error(path.string() + ": " + unusable.what());
  }
  const std::string text = format_samples(samples);
  write_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace gonio::io
