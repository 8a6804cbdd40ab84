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

void split_fields(std::string_view line, std::vector<std::string_view>& fields);

/// The header line: which column each field of a line is, and how directions are given.
class sample_header {
 public:
  sample_header(std::string_view line, bool needs_colour, const text_place& place);

  [[nodiscard]] std::span<const std::size_t> columns() const noexcept { return columns_; }
  [[nodiscard]] const column_group& directions() const noexcept { return directions_; }

 private:
  void add(std::string_view field, const text_place& place);

  void find_directions(const text_place& place);

  [[nodiscard]] bool has(std::size_t column) const { return std::ranges::find(columns_, column) != columns_.end(); }
  [[nodiscard]] bool has_any(const column_group& group) const;
  void require(const column_group& group, const text_place& place) const;

  std::vector<std::size_t> columns_;
  column_group directions_;
};

/// A polar angle in radians. A goniometer's arm may lean to either side: there a negative angle is as good
/// as an azimuth of 180 degrees.
[[nodiscard]] double polar_angle(const sample_row& row, std::size_t column, bool either_side, const text_place& place);

[[nodiscard]] double azimuth(const sample_row& row, std::size_t column, const text_place& place);

[[nodiscard]] direction unit_vector(const sample_row& row, std::size_t first, const text_place& place);

/// A line of numbers, in its place.
struct parsed_row {
  const sample_row& numbers;
  const column_group& group;  ///< how directions are given
  const text_place& place;

  [[nodiscard]] bool has_half_difference() const noexcept { return group.first == half_difference_group.first; }
};

void require_above_horizon(const cosine_pair& cosine, const parsed_row& row);

/// Of a row that gives half and difference angles.
[[nodiscard]] half_difference given_angles(const parsed_row& row);

/// Light and viewer of a row that gives directions.
[[nodiscard]] direction_pair given_directions(const parsed_row& row);

[[nodiscard]] half_difference row_angles(const parsed_row& row);

[[nodiscard]] direction_pair row_directions(const parsed_row& row);

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
  if (!header) throw error{name, ": is empty, expected a header line that names the columns"};
  if (rows == 0) throw error{name, ": has a header line but no samples, expected at least one"};
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
[[nodiscard]] sample_set parse_samples(std::string_view text, const std::string& name);

/// Reads measurements. Throws gonio::error naming file, line, column and value of what is wrong.
[[nodiscard]] sample_set read_samples(const std::filesystem::path& path);

/// Reads directions alone; the file may have `r,g,b` and `weight` columns, which are checked and left out.
[[nodiscard]] inline std::vector<half_difference> read_directions(const std::filesystem::path& path) {
  return detail::read_rows(path, [](const detail::parsed_row& row) { return detail::row_angles(row); });
}

/// Reads the same files as pairs, in which light and viewer are told apart.
[[nodiscard]] inline std::vector<direction_pair> read_direction_pairs(const std::filesystem::path& path) {
  return detail::read_rows(path, [](const detail::parsed_row& row) { return detail::row_directions(row); });
}

/// Writes pairs as `theta_i,phi_i,theta_o,phi_o`, rounded to 1e-9 degrees.
void write_direction_pairs(const std::filesystem::path& path, std::span<const direction_pair> pairs);

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
    throw error{path.string(), ": ", unusable.what()};
  }
  const std::string text = format_samples(samples);
  write_atomically(path, std::as_bytes(std::span(text)));
}

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/samples.ipp>
#endif
