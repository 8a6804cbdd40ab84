#pragma once
/// Bodies of io/measurements/samples.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/sample_header.hpp>
#include <gonio/io/measurements/sample_quantity.hpp>
#include <gonio/io/measurements/sample_rows.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>
#include <gonio/table/viewer_side.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// Returns a polar angle in radians. With `either_side` it may be negative, as for a goniometer's arm: this turns the
/// azimuth by 180 degrees.
[[nodiscard]] GONIO_INLINE double polar_angle(const sample_row& row, std::size_t column, bool either_side,
                                              const text_position& position) {
  const double angle = row[column];
  if (!((angle >= 0.0 || either_side) && std::abs(angle) < 90.0))
    position.refuse({"column ", sample_columns[column], ": ", shortest(angle), " degrees",
                     angle < 0.0 && !either_side ? " is negative" : " is at or below the horizon", ", expected ",
                     either_side ? "between -90 and 90" : "at least 0 and less than 90"});
  return radians(angle);
}

[[nodiscard]] GONIO_INLINE double azimuth(const sample_row& row, std::size_t column, const text_position& position) {
  if (!(std::abs(row[column]) <= 360.0))
    position.refuse(
        {"column ", sample_columns[column], ": ", shortest(row[column]), " degrees, expected from -360 to 360"});
  return radians(row[column]);
}

[[nodiscard]] GONIO_INLINE direction unit_vector(const sample_row& row, std::size_t first,
                                                 const text_position& position) {
  const double x = row[first], y = row[first + 1], z = row[first + 2];
  const double length = gonio::norm_of(x, y, z);
  const auto refuse = [&](const char* what, double value, const char* expected) {
    position.refuse(
        {"columns ", sample_columns[first], " to ", sample_columns[first + 2], what, shortest(value), expected});
  };
  if (!(std::abs(length - 1.0) <= 1e-3)) refuse(": the vector has length ", length, ", expected 1");
  if (!(z > 0.0)) refuse(": the direction is at or below the horizon, its z is ", z, "");
  return {x / length, y / length, z / length};
}

GONIO_INLINE void require_above_horizon(const cosine_pair& cosine, const row_view& row) {
  if (cosine.i > 0.0 && cosine.o > 0.0) return;
  std::string given;
  for (std::size_t column = row.group.first; column < row.group.first + row.group.count; ++column)
    given += message_of({given.empty() ? "" : ", ", sample_columns[column], " ", shortest(row.numbers[column])});
  row.position.refuse({"a direction is at or below the horizon (", given, ")"});
}

/// Returns the angles of a row that gives half and difference angles.
[[nodiscard]] GONIO_INLINE half_difference given_angles(const row_view& row) {
  return {polar_angle(row.numbers, 0, false, row.position), polar_angle(row.numbers, 1, false, row.position),
          azimuth(row.numbers, 2, row.position)};
}

/// Returns light and viewer of a row that gives directions.
[[nodiscard]] GONIO_INLINE direction_pair given_directions(const row_view& row) {
  const sample_row& numbers = row.numbers;
  const text_position& position = row.position;
  if (row.group.first == vector_group.first)
    return {unit_vector(numbers, 7, position), unit_vector(numbers, 10, position)};
  const double theta_i = polar_angle(numbers, 3, true, position), theta_o = polar_angle(numbers, 5, true, position);
  return {spherical_direction(theta_i, azimuth(numbers, 4, position)),
          spherical_direction(theta_o, azimuth(numbers, 6, position))};
}

/// Returns the angles as given. If phi_d is outside half a turn, returns a pair of directions instead: folding phi_d
/// would exchange light and viewer.
[[nodiscard]] GONIO_INLINE sample_directions directions_of(const half_difference& given) {
  if (fold_phi_d(given.phi_d) == given.phi_d) return given;
  return to_directions(given);
}

/// Returns a row's directions. Refuses grazing directions that rounding puts below the horizon in either form, as
/// angles or as a pair.
[[nodiscard]] GONIO_INLINE sample_directions row_directions(const row_view& row) {
  const sample_directions given = row.has_half_difference() ? directions_of(given_angles(row)) : given_directions(row);
  require_above_horizon(cosines(given.angles()), row);
  require_above_horizon({given.pair().wi.z(), given.pair().wo.z()}, row);
  return given;
}

/// Is light or viewer at 90 degrees? Goniometers reach this angle, where there is no BRDF.
[[nodiscard]] GONIO_INLINE bool is_at_horizon(const row_view& row) {
  if (row.has_half_difference() || row.group.first == vector_group.first) return false;
  return std::abs(row.numbers[3]) == 90.0 || std::abs(row.numbers[5]) == 90.0;
}

[[nodiscard]] GONIO_INLINE channel_weights row_weight(const row_view& row) {
  const double* first = &row.numbers[row.weights.first];
  return row.weights.count == 1 ? channel_weights(first[0]) : channel_weights(rgb(first[0], first[1], first[2]));
}

[[nodiscard]] GONIO_INLINE aperture row_aperture(const row_view& row) {
  const auto half_angle = [&](std::size_t column) {
    const double angle = radians(row.numbers[column]);
    if (!(angle >= 0.0 && angle <= largest_half_angle))
      row.position.refuse(
          {sample_columns[column], ": ", shortest(row.numbers[column]), " degrees, expected from 0 to 45"});
    return angle;
  };
  return {half_angle(half_angle_group.first), half_angle(half_angle_group.first + 1)};
}

/// Throws gonio::error if the quantity is unknown; r,g,b are always a BRDF.
GONIO_INLINE void require_quantity(const row_view& row) {
  if (row.quantity || row.values.first == colour_group.first) return;
  row.position.refuse({"the file does not state the quantity of ", row.header.name_of(row.values.first),
                       ", expected a comment line '# quantity: brdf' above, or brdf-cosine, reflectance-factor or "
                       "percent (or the option --quantity)"});
}

GONIO_INLINE void refuse_float_overflow(const row_view& row, std::size_t column, double value) {
  row.position.refuse(
      {"column ", row.header.name_of(column), ": ", shortest(value), " sr^-1 is outside the range of float"});
}

/// Converts the values of a row to a BRDF, sr^-1.
GONIO_INLINE void read_row_values(const row_view& row, const sample_directions& directions,
                                  std::vector<double>& values) {
  require_quantity(row);
  const double factor = brdf_factor(row.quantity.value_or(sample_quantity::brdf), directions.pair().wo);
  values.clear();
  for (std::size_t column = row.values.first; column < row.values.first + row.values.count; ++column)
    values.push_back(factor * row.numbers[column]);
  if (row.values.first == tristimulus_group.first) {
    const rgb colour = from_xyz({values[0], values[1], values[2]});
    values.assign(colour.begin(), colour.end());
  }
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!(std::abs(values[k]) <= double{std::numeric_limits<float>::max()}))
      refuse_float_overflow(row, row.values.first + k, values[k]);
}

/// Returns the channels of a file whose first row has been read.
[[nodiscard]] GONIO_INLINE channels channels_of(const sample_rows& rows) {
  if (rows.row().values.count == 3 && rows.header().wavelengths().empty()) return {};
  if (!rows.header().wavelengths().empty()) return channels(rows.header().wavelengths());
  return rows.wavelength() ? channels({*rows.wavelength()}) : channels::one_value();
}

/// Throws gonio::error for a scan without azimuths that is bright towards the light and dark in the mirror direction.
GONIO_INLINE void require_plausible_sides(const sample_set& samples, const std::string& name) {
  const double ratio = brightness_towards_light(samples);
  if (ratio > implausible_brightness_towards_light)
    gonio::refuse(
        {name, ": at theta_o = theta_i the sample is ", shortest(std::round(10.0 * ratio) / 10.0),
         " times as bright as on the other side of the normal: give --theta-o-sign mirror if theta_o is positive "
         "towards the mirror direction, --theta-o-sign light if the material reflects the light back"});
}

/// Notes how many rows are left out and why; throws gonio::error if they are more than the `kept` rows.
GONIO_INLINE void note_omitted(const sample_rows& rows, std::size_t at_horizon, std::size_t kept,
                               const sample_reading& reading, const std::string& name) {
  const std::size_t omitted = at_horizon + rows.rows_without_value();
  if (omitted == 0) return;
  std::string reasons = at_horizon > 0 ? "light or viewer is at 90 degrees" : "";
  if (rows.rows_without_value() > 0) reasons += message_of({reasons.empty() ? "" : "; ", rows.first_without_value()});
  const std::string counts = message_of({name, ": ", omitted, " of ", omitted + kept, " ", rows.rows_are_called(2),
                                         omitted == 1 ? " is" : " are", " left out: ", reasons});
  if (omitted > kept) gonio::refuse({counts, ", expected at most half"});
  if (reading.note) reading.note(counts);
}

/// A file of X, Y and Z may lack a statement of its quantity. Returns `reading` with the quantity to assume, from a
/// first pass over the file: percent if the median of Y is above 1.5, which no matt surface reaches; reflectance
/// factors if no Y is above 1. Otherwise throws gonio::error.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE sample_reading with_assumed_scale(std::string_view text,
                                                                           const std::string& name,
                                                                           const sample_reading& reading) {
  sample_reading with_scale = reading;
  with_scale.note = {};
  std::vector<double> all;
  for (sample_rows rows(text, name, true, with_scale); rows.next();)
    all.push_back(rows.row().numbers[tristimulus_group.first + 1]);
  const double largest = *std::ranges::max_element(all), middle = median(all);
  const bool are_percent = middle > 1.5;
  if (!are_percent && largest > 1.0)
    gonio::refuse({name, ": the largest Y is ", shortest(largest), ", the median ", shortest(middle),
                   ": give --quantity reflectance-factor if a perfect diffuser has Y 1, --quantity percent if it has "
                   "Y 100, or a comment line such as '# quantity: percent'"});
  if (reading.note)
    reading.note(message_of({name, ": a perfect diffuser is taken to have Y ", are_percent ? "100" : "1",
                             ", as the largest Y is ", shortest(largest), ", the median ", shortest(middle),
                             " (--quantity ", are_percent ? "reflectance-factor: Y 1" : "percent: Y 100", ")"}));
  with_scale.note = reading.note;
  with_scale.quantity = are_percent ? sample_quantity::percent : sample_quantity::reflectance_factor;
  return with_scale;
}

/// Returns the names of the columns of values.
[[nodiscard]] GONIO_INLINE std::string column_names(const channels& kinds) {
  if (kinds.are_colours()) return "r,g,b,";
  if (kinds.wavelengths().empty()) return "value,";
  std::string names;
  for (const double wavelength : kinds.wavelengths()) names += message_of({shortest(wavelength), "nm,"});
  return names;
}

[[gnu::cold]] GONIO_INLINE void write_text(const std::filesystem::path& path, std::string_view text) {
  write_atomically(path, {reinterpret_cast<const std::byte*>(text.data()), text.size()});
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE sample_file read_sample_file(std::string_view text, const std::string& name,
                                          const sample_reading& reading) {
  sample_file file;
  detail::sample_rows rows(text, name, true, reading);
  std::vector<double> values;
  std::size_t at_horizon = 0;
  while (rows.next()) {
    const detail::row_view row = rows.row();
    if (detail::is_at_horizon(row)) {
      ++at_horizon;
      continue;
    }
    if (row.values.first == detail::tristimulus_group.first && !row.quantity)
      return read_sample_file(text, name, detail::with_assumed_scale(text, name, reading));
    if (file.samples.empty()) file.samples = sample_set(detail::channels_of(rows));
    if (row.weights.count > 1 && file.samples.channels().are_wavelengths())
      row.position.refuse("samples at wavelengths have one weight, expected weight, not one for each channel");
    const sample_directions directions = detail::row_directions(row);
    detail::read_row_values(row, directions, values);
    file.samples.add(directions, values, detail::row_weight(row), detail::row_aperture(row));
    file.text.lines.push_back(row.position.line);
  }
  if (file.samples.empty()) gonio::refuse({name, ": has no sample above the horizon, expected at least one"});
  detail::note_omitted(rows, at_horizon, static_cast<std::size_t>(file.samples.size()), reading, name);
  if (rows.assumes_side()) detail::require_plausible_sides(file.samples, name);
  if (rows.turns_viewers()) file.samples = with_viewers_turned(file.samples);
  file.quantity = rows.quantity();
  file.sign = rows.sign();
  file.provenance = rows.provenance();
  file.text.dialect = rows.dialect();
  file.text.omitted_rows = at_horizon + rows.rows_without_value();
  file.text.assumes_side = rows.assumes_side();
  return file;
}

GONIO_INLINE sample_set read_samples(std::string_view text, const std::string& name, const sample_reading& reading) {
  return read_sample_file(text, name, reading).samples;
}

[[gnu::cold]] GONIO_INLINE sample_file read_sample_file(const std::filesystem::path& path,
                                                        const sample_reading& reading) {
  const auto bytes = read_bytes(path);
  return read_sample_file(as_text(bytes), path.string(), reading);
}

[[gnu::cold]] GONIO_INLINE bool has_directions_alone(std::string_view text, const std::string& name,
                                                     const sample_reading& reading) {
  detail::sample_rows rows(text, name, false, reading);
  return rows.next() && rows.row().values.count == 0;
}

GONIO_INLINE sample_set read_samples(const std::filesystem::path& path, const sample_reading& reading) {
  return read_sample_file(path, reading).samples;
}

[[gnu::cold]] GONIO_INLINE std::vector<half_difference> read_directions(std::string_view text, const std::string& name,
                                                                        const sample_reading& reading) {
  detail::sample_rows rows(text, name, false, reading);
  std::vector<half_difference> all;
  while (rows.next()) all.push_back(detail::row_directions(rows.row()).angles());
  return all;
}

[[gnu::cold]] GONIO_INLINE std::vector<half_difference> read_directions(const std::filesystem::path& path,
                                                                        const sample_reading& reading) {
  const auto bytes = read_bytes(path);
  return read_directions(as_text(bytes), path.string(), reading);
}

[[gnu::cold]] GONIO_INLINE std::vector<direction_pair> read_direction_pairs(std::string_view text,
                                                                            const std::string& name,
                                                                            const sample_reading& reading) {
  detail::sample_rows rows(text, name, false, reading);
  std::vector<direction_pair> all;
  while (rows.next()) all.push_back(detail::row_directions(rows.row()).pair());
  return all;
}

[[gnu::cold]] GONIO_INLINE std::vector<direction_pair> read_direction_pairs(const std::filesystem::path& path,
                                                                            const sample_reading& reading) {
  const auto bytes = read_bytes(path);
  return read_direction_pairs(as_text(bytes), path.string(), reading);
}

namespace detail {

/// Returns the numbers of a sample's directions, in degrees.
[[nodiscard]] inline std::vector<double> direction_numbers(const sample_directions& directions,
                                                           direction_columns columns) {
  if (columns == direction_columns::half_difference) {
    const half_difference& angles = directions.angles();
    return {degrees(angles.theta_h), degrees(angles.theta_d), degrees(fold_phi_d(angles.phi_d))};
  }
  const auto rounded = [](double angle) { return std::round(degrees(angle) * 1e9) / 1e9 + 0.0; };
  const auto& [wi, wo] = directions.pair();
  return {rounded(gonio::polar_angle(wi)), rounded(gonio::azimuth(wi)), rounded(gonio::polar_angle(wo)),
          rounded(gonio::azimuth(wo))};
}

}  // namespace detail

GONIO_INLINE std::string write_samples(const sample_set& samples, const sample_provenance& provenance,
                                       direction_columns columns) {
  const channels& kinds = samples.channels();
  const bool apart = !kinds.are_wavelengths() && weigh_channels_apart(samples), through = samples.have_apertures();
  std::string text = comment_lines(provenance);
  if (!kinds.are_colours()) text += "# quantity: brdf\n";
  text += columns == direction_columns::pairs ? "theta_i,phi_i,theta_o,phi_o," : "theta_h,theta_d,phi_d,";
  text += detail::column_names(kinds);
  text += apart ? "weight_r,weight_g,weight_b" : "weight";
  text += through ? ",source_half_angle,receiver_half_angle\n" : "\n";
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    std::vector<double> numbers = detail::direction_numbers(samples.directions(i), columns);
    numbers.insert(numbers.end(), samples.values(i).begin(), samples.values(i).end());
    for (Eigen::Index c = 0; c < (apart ? 3 : 1); ++c) numbers.push_back(samples.weight(i)[c]);
    if (through)
      numbers.insert(numbers.end(), {degrees(samples.aperture(i).source), degrees(samples.aperture(i).receiver)});
    for (std::size_t k = 0; k < numbers.size(); ++k) text += (k == 0 ? "" : ",") + shortest(numbers[k]);
    text += '\n';
  }
  return text;
}

GONIO_INLINE void write_samples(const std::filesystem::path& path, const sample_set& samples,
                                const sample_provenance& provenance, direction_columns columns) {
  try {
    require_usable(samples);
  } catch (const error& unusable) {
    gonio::refuse({path.string(), ": ", unusable.what()});
  }
  detail::write_text(path, write_samples(samples, provenance, columns));
}

[[gnu::cold]] GONIO_INLINE void write_direction_pairs(const std::filesystem::path& path,
                                                      std::span<const direction_pair> pairs) {
  const auto rounded = [](double angle) { return shortest(std::round(degrees(angle) * 1e9) / 1e9 + 0.0); };
  std::string text = "theta_i,phi_i,theta_o,phi_o\n";
  for (const auto& [wi, wo] : pairs)
    text += message_of({rounded(gonio::polar_angle(wi)), ",", rounded(gonio::azimuth(wi)), ",",
                        rounded(gonio::polar_angle(wo)), ",", rounded(gonio::azimuth(wo)), "\n"});
  detail::write_text(path, text);
}

}  // namespace gonio::io
