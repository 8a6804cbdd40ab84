#pragma once
/// Bodies of io/measurements/sample_header.hpp. Functions called once per file are cold, so that compilers do not
/// spend seconds on optimising them.

#include <gonio/core/compiled.hpp>
#include <gonio/core/spelling.hpp>
#include <gonio/io/measurements/sample_columns.hpp>
#include <gonio/io/measurements/sample_header.hpp>
#include <gonio/io/measurements/sample_layout.hpp>
#include <gonio/io/measurements/sample_quantity.hpp>
#include <gonio/io/text/csv_dialect.hpp>
#include <gonio/io/text/csv_reader.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

// ---- names ---------------------------------------------------------------------------------------------------------

/// Returns the wavelength in a column's name: 400nm, "400 [nm]", w400, lambda_400, or a bare number in a plausible
/// range; 0 for any other name.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE double wavelength_named(const written_column& written) {
  constexpr double least_bare = 100.0, most_bare = 20'000.0;
  std::string_view name = written.name;
  bool is_bare = written.unit.empty();
  if (!is_bare && unit_named(written.unit) != column_unit::nanometres) return 0.0;
  for (const std::string_view prefix : {"lambda_", "lambda", "wl", "w"})
    if (is_bare && name.starts_with(prefix)) {
      name.remove_prefix(prefix.size());
      is_bare = false;
    }
  if (name.ends_with("nm")) {
    name = trimmed(name.substr(0, name.size() - 2));
    is_bare = false;
  }
  std::string digits(name);  // the file's decimal mark is not known yet
  std::ranges::replace(digits, ',', '.');
  double nanometres = 0.0;
  if (read_number(digits, nanometres) != nullptr || !(nanometres > 0.0)) return 0.0;
  return is_bare && (nanometres < least_bare || nanometres > most_bare) ? 0.0 : nanometres;
}

[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::size_t column_named(std::string_view name) {
  std::size_t column = 0;
  while (column < sample_columns.size() && sample_columns[column] != name) ++column;
  return column;
}

/// Returns the caller's entry for this name of the file; nullptr if there is none.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE const column_name* find_renamed(const written_column& written,
                                                                         const std::vector<column_name>& names) {
  const std::string text = lower_case(written.text);
  for (const column_name& each : names) {
    const std::string wanted = lower_case(trimmed(each.in_file));
    if (wanted == text || wanted == written.name) return &each;
  }
  return nullptr;
}

/// Longer names in a file are not compared with the columns' names.
inline constexpr std::size_t longest_name = 40;

// ---- the header line -----------------------------------------------------------------------------------------------

[[gnu::cold]] GONIO_INLINE std::size_t find_column(std::string_view name, const sample_reading& reading) {
  const written_column column = written(name);
  if (const column_name* renamed = find_renamed(column, reading.columns)) return column_named(renamed->column);
  const known_name* known = find_known(column.name);
  return known != nullptr ? known->column : sample_header::ignored;
}

[[gnu::cold]] GONIO_INLINE bool name_directions(std::span<const std::string_view> fields,
                                                const sample_reading& reading) {
  std::size_t count = 0;
  for (const std::string_view field : fields)
    if (find_column(field, reading) < colour_group.first) ++count;
  return count >= 2;
}

[[gnu::cold]] GONIO_INLINE bool name_angle_and_values(std::span<const std::string_view> fields,
                                                      const sample_reading& reading) {
  bool has_angle = false, has_value = false;
  for (const std::string_view field : fields) {
    const std::size_t column = find_column(field, reading);
    has_angle |= angle_group.has(column);
    has_value |= grey_group.has(column) || colour_group.has(column) || tristimulus_group.has(column) ||
                 wavelength_named(written(field)) != 0.0;
  }
  return has_angle && has_value;
}

[[gnu::cold]] GONIO_INLINE void sample_header::read(csv_reader& file, const sample_reading& reading, bool needs_value,
                                                    std::span<const stated_angle> stated) {
  dialect_ = file.dialect();
  const text_position position = file.position();
  double number = 0.0;
  csv_dialect of_numbers = dialect_;
  if (of_numbers.read_number(file.fields().front(), number) == nullptr)
    position.refuse(
        {"there is no header line above the numbers, expected one like theta_i,phi_i,theta_o,phi_o,r,g,b (text "
         "after # is a comment); the line looks ",
         description(dialect_)});
  for (const column_name& each : reading.columns)
    if (column_named(each.column) == ignored)
      position.refuse({"samples have no column ", in_quotes(each.column), " for ", in_quotes(each.in_file),
                       " of the file, expected theta_i, value or another known column"});
  std::vector<written_column> names;
  for (const std::string_view field : file.fields()) names.push_back(written(field));
  matrix_ = matrix_of(file.fields(), [&](std::string_view name) { return find_column(name, reading); });
  if (file.next_if(are_units))
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i].unit.empty()) names[i].unit = unit_of(file.fields()[i]);
  if (matrix_) return read_matrix(names, position);
  for (const written_column& each : names) add(each, reading, position);
  ignore_tristimulus(names);
  require_named(reading, position);
  find_stated(stated, position);
  find_directions(position);
  find_values(needs_value, position);
  find_weights(position);
}

/// The first column of a matrix has the angle of each row; all other columns have values.
[[gnu::cold]] GONIO_INLINE void sample_header::read_matrix(const std::vector<written_column>& names,
                                                           const text_position& position) {
  columns_.assign(names.size(), grey_group.first);
  columns_.front() = matrix_->down;
  directions_ = angle_group;
  values_ = grey_group;
  is_in_plane_ = true;
  for (std::size_t i = 1; i < names.size(); ++i)
    if (unit_named(names[i].unit) == column_unit::percent)
      return quantity_.state_percent_signs("the line of units", position);
}

/// Adds the stated angles that have no column. Adds an azimuth only if the other azimuth has a column; otherwise the
/// file is in-plane.
[[gnu::cold]] GONIO_INLINE void sample_header::find_stated(std::span<const stated_angle> stated,
                                                           const text_position& position) {
  if (!has_any(angle_group)) return;
  const auto take = [&](std::size_t column) {
    if (has(column)) return;
    for (const stated_angle& each : stated) {
      if (each.column != column) continue;
      if (stated_.empty() || stated_.back().column != column) stated_.push_back(each);
      if (each.degrees != stated_.back().degrees)
        position.refuse({sample_columns[column], " is stated twice above the header line, ",
                         shortest(stated_.back().degrees), " and ", shortest(each.degrees), " degrees, expected once"});
    }
  };
  const std::size_t theta_i = angle_group.first, phi_i = theta_i + 1, theta_o = theta_i + 2, phi_o = theta_i + 3;
  for (const std::size_t polar : {theta_i, theta_o}) take(polar);
  if (!relative_azimuth_.empty()) return;
  if (has(phi_o)) take(phi_i);
  if (has(phi_i)) take(phi_o);
}

[[gnu::cold]] GONIO_INLINE void sample_header::add(const written_column& written, const sample_reading& reading,
                                                   const text_position& position) {
  if (const column_name* renamed = find_renamed(written, reading.columns)) {
    written_column named = written;
    const std::size_t column = column_named(renamed->column);
    if (!fits(unit_named(named.unit), column)) named.unit.clear();
    if (add_known(named, {"", column}, position)) return;
  } else if (const known_name* known = find_known(written.name)) {
    bool is_another = false;
    for (const column_name& each : reading.columns) is_another |= each.column == sample_columns[known->column];
    if (!is_another && add_known(written, *known, position)) return;
  } else if (add_wavelength(written, position)) {
    return;
  }
  columns_.push_back(ignored);
  extra_.push_back(written);
}

/// Adds a column with a known name. Returns false if its unit does not fit.
[[gnu::cold]] GONIO_INLINE bool sample_header::add_known(const written_column& written, const known_name& known,
                                                         const text_position& position) {
  const std::size_t column = known.column;
  const column_unit unit = unit_named(written.unit);
  if (!fits(unit, column)) return false;
  if (known.is_relative && has(column)) return false;  // phi_o has a column of its own
  // In lower case, x, y and z are chromaticities or coordinates.
  if (tristimulus_group.has(column) && (has(column) || written.text.front() < 'A' || written.text.front() > 'Z'))
    return false;
  const std::string text = in_quotes(written.text);
  const std::string_view name = sample_columns[column];
  const bool is_synonym = written.text != name;
  if (has(column))
    position.refuse({"column ", text, is_synonym ? ", which is " : "", is_synonym ? name : "", is_synonym ? "," : "",
                     " appears twice"});
  columns_.push_back(column);
  if (known.is_relative) relative_azimuth_ = written.text;
  if (unit == column_unit::radians) in_radians_.push_back(column);
  if (known.quantity) quantity_.state(*known.quantity, message_of({"the name of column ", text}), position);
  if (unit == column_unit::percent) quantity_.state_percent_signs(message_of({"the unit of column ", text}), position);
  return true;
}

/// Adds a column named by its wavelength. Returns false if the name is not a wavelength.
[[gnu::cold]] GONIO_INLINE bool sample_header::add_wavelength(const written_column& written,
                                                              const text_position& position) {
  const double nanometres = wavelength_named(written);
  if (nanometres == 0.0) return false;
  if (!wavelengths_.empty() && !(nanometres > wavelengths_.back()))
    position.refuse({"column ", in_quotes(written.text), " follows the column of ", shortest(wavelengths_.back()),
                     " nm, expected wavelengths that ascend without repeats"});
  wavelengths_.push_back(nanometres);
  columns_.push_back(ignored + wavelengths_.size());
  return true;
}

[[gnu::cold]] GONIO_INLINE std::string sample_header::name_of(std::size_t column) const {
  if (column < ignored) return std::string(sample_columns[column]);
  return message_of({shortest(wavelengths_[column - ignored - 1]), "nm"});
}

/// Throws gonio::error if a column named by the caller is missing.
[[gnu::cold]] GONIO_INLINE void sample_header::require_named(const sample_reading& reading,
                                                             const text_position& position) const {
  for (const column_name& each : reading.columns)
    if (!has(column_named(each.column)))
      position.refuse({"there is no column ", in_quotes(each.in_file), " for ", each.column, "; ", as_it_looks()});
}

[[gnu::cold]] GONIO_INLINE void sample_header::find_directions(const text_position& position) {
  int groups = 0;
  for (const column_group& group : {half_difference_group, angle_group, vector_group}) {
    if (!has_any(group)) continue;
    directions_ = group;
    ++groups;
  }
  if (groups == 0)
    position.refuse({"there are no columns of directions, expected theta_h,theta_d,phi_d or ",
                     "theta_i,phi_i,theta_o,phi_o or wi_x,wi_y,wi_z,wo_x,wo_y,wo_z; ", as_it_looks()});
  if (groups > 1) position.refuse("directions are given in more than one way, expected one of them");
  is_in_plane_ = directions_.first == angle_group.first && !has(4) && !has(6);
  if (!relative_azimuth_.empty() && has(4))
    position.refuse({in_quotes(relative_azimuth_),
                     " is read as phi_o - phi_i, but there is a column phi_i, expected one of "
                     "them"});
  if (!is_in_plane_ && relative_azimuth_.empty()) return require(directions_, position);
  for (const std::size_t polar : {std::size_t{3}, std::size_t{5}})
    if (!knows(polar)) refuse_missing(polar, position);
  if (!is_in_plane_) return;
  // A misspelt azimuth does not count as an absent one.
  for (const written_column& each : extra_)
    for (const std::size_t azimuth : {std::size_t{4}, std::size_t{6}})
      if (each.name.find("phi") != std::string::npos || each.name.find("azim") != std::string::npos ||
          nearest_word(sample_columns[azimuth], {each.name}))
        refuse_missing(azimuth, position);
}

[[gnu::cold]] GONIO_INLINE void sample_header::find_values(bool needs_value, const text_position& position) {
  use_r_as_value(position);
  const bool is_tristimulus = has_any(tristimulus_group);
  const bool is_grey = has_any(grey_group), is_colour = has_any(colour_group), is_spectral = !wavelengths_.empty();
  if (int{is_grey} + int{is_colour} + int{is_spectral} > 1)
    position.refuse({"reflectance is given in two ways, expected r,g,b or value",
                     is_spectral ? " or columns of wavelengths, such as " : "",
                     is_spectral ? name_of(ignored + 1) : ""});
  if (is_grey) values_ = grey_group;
  if (is_spectral) values_ = {ignored + 1, wavelengths_.size()};
  if (is_tristimulus) values_ = tristimulus_group;
  if (!is_grey && !is_spectral && !is_tristimulus && (is_colour || needs_value)) {
    require(colour_group, position);
    values_ = colour_group;
  }
  has_wavelength_ = has(wavelength_column);
  if (has_wavelength_ && values_.count == 3 && !is_spectral)
    position.refuse({is_tristimulus ? "X,Y,Z" : "r,g,b", " cannot have a wavelength, expected value"});
  if (has_wavelength_ && is_spectral)
    position.refuse({"the file has a column wavelength and ", name_of(ignored + 1), ", expected one of them"});
}

/// X, Y and Z are tristimulus values only if all three are present and there are no other values.
[[gnu::cold]] GONIO_INLINE void sample_header::ignore_tristimulus(const std::vector<written_column>& names) {
  bool are_values = !has_any(grey_group) && !has_any(colour_group) && wavelengths_.empty();
  for (std::size_t k = 0; k < tristimulus_group.count; ++k) are_values &= has(tristimulus_group.first + k);
  if (are_values) return;
  extra_.clear();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (tristimulus_group.has(columns_[i])) columns_[i] = ignored;
    if (columns_[i] == ignored) extra_.push_back(names[i]);
  }
}

/// A column R without G and B is not red; with percent signs it is a reflectance factor.
[[gnu::cold]] GONIO_INLINE void sample_header::use_r_as_value(const text_position& position) {
  const auto r = std::ranges::find(columns_, colour_group.first);
  if (r == columns_.end() || has(colour_group.first + 1) || has(colour_group.first + 2) || has_any(grey_group)) return;
  if (quantity_.quantity() != sample_quantity::percent)
    position.refuse(
        {"column 'g' is missing, expected r,g,b, or value for one channel, or columns such as 400nm; if the "
         "column R is the only value, give --columns value=R; the header line looks ",
         description(dialect_)});
  *r = grey_group.first;
}

[[gnu::cold]] GONIO_INLINE void sample_header::find_weights(const text_position& position) {
  if (!has_any(channel_weight_group)) return;
  if (has_any(weight_group))
    position.refuse("weights are given in two ways, expected weight or weight_r,weight_g,weight_b");
  if (!wavelengths_.empty())
    position.refuse("samples at wavelengths have one weight, expected weight, not one for each channel");
  require(channel_weight_group, position);
  weights_ = channel_weight_group;
}

[[gnu::cold]] GONIO_INLINE bool sample_header::has_any(const column_group& group) const {
  for (const std::size_t column : columns_)
    if (group.has(column)) return true;
  return false;
}

[[gnu::cold]] GONIO_INLINE void sample_header::require(const column_group& group, const text_position& position) const {
  for (std::size_t column = group.first; column < group.first + group.count; ++column)
    if (!knows(column)) refuse_missing(column, position);
}

/// Does the file have this column, or state its angle for all samples?
[[gnu::cold]] GONIO_INLINE bool sample_header::knows(std::size_t column) const {
  return has(column) || std::ranges::find(stated_, column, &stated_angle::column) != stated_.end();
}

[[gnu::cold]] GONIO_INLINE void sample_header::refuse_missing(std::size_t column, const text_position& position) const {
  std::vector<std::string> names;
  for (const written_column& each : extra_)
    if (each.name.size() <= longest_name) names.push_back(each.name);
  const std::string_view name = sample_columns[column];
  const std::string looks = as_it_looks();
  if (const auto near = nearest_word(name, names))
    for (const written_column& each : extra_)
      if (each.name == *near)
        position.refuse({"column '", name, "' is missing: perhaps it is ", in_quotes(each.text), "; ", looks});
  position.refuse(
      {"column '", name, "' is missing",
       colour_group.has(column) ? ", expected r,g,b, or value for one channel, or columns such as 400nm; " : "; ",
       looks});
}

/// The number of names that messages show of a long list.
inline constexpr std::size_t most_listed = 6;

[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::string how_many_more(std::size_t count) {
  return count <= most_listed ? "" : message_of({" and ", count - most_listed, " more"});
}

[[gnu::cold]] GONIO_INLINE std::string sample_header::as_it_looks() const {
  std::string unknown;
  for (std::size_t i = 0; i < std::min(most_listed, extra_.size()); ++i)
    unknown += message_of({i == 0 ? "" : ", ", in_quotes(extra_[i].text)});
  return message_of({"the header line looks ", description(dialect_),
                     extra_.empty() ? "" : ", unknown columns: ", unknown, how_many_more(extra_.size()),
                     extra_.empty() ? "" : " (--columns NAME=THEIRS names them)"});
}

[[gnu::cold]] GONIO_INLINE std::string sample_header::note_of_ignored() const {
  if (extra_.empty()) return "";
  std::vector<std::string> optional;
  for (const std::size_t column : {weight_group.first, channel_weight_group.first, channel_weight_group.first + 1,
                                   channel_weight_group.first + 2, wavelength_column, quantity_column})
    if (!has(column)) optional.emplace_back(sample_columns[column]);
  const bool is_one = extra_.size() == 1;
  std::string names;
  for (std::size_t i = 0; i < std::min(most_listed, extra_.size()); ++i) {
    names += message_of({i == 0 ? "" : ", ", in_quotes(extra_[i].text)});
    if (extra_[i].name.size() > longest_name) continue;
    if (const auto near = nearest_word(extra_[i].name, optional)) names += message_of({" (is it ", *near, "?)"});
  }
  return message_of(
      {is_one ? "column " : "columns ", names, how_many_more(extra_.size()), is_one ? " is ignored" : " are ignored"});
}

}  // namespace gonio::io::detail
