#pragma once
/// Bodies of io/measurements/sample_rows.hpp. Functions called once per file are cold, so that compilers do not
/// spend seconds on optimising them.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/measurements/sample_header.hpp>
#include <gonio/io/measurements/sample_layout.hpp>
#include <gonio/io/measurements/sample_provenance.hpp>
#include <gonio/io/measurements/sample_quantity.hpp>
#include <gonio/io/measurements/sample_rows.hpp>
#include <gonio/io/text/csv_dialect.hpp>
#include <gonio/io/text/csv_reader.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

[[gnu::cold]] GONIO_INLINE sample_rows::sample_rows(std::string_view text, const std::string& name, bool needs_value,
                                                    const sample_reading& reading)
    : csv_(text, name), needs_value_(needs_value), reading_(reading), sign_(reading.sign) {
  numbers_[weight_group.first] = 1.0;
  if (reading.quantity) quantity_.state(*reading.quantity, "the requested quantity (--quantity)", csv_.position());
}

GONIO_INLINE bool sample_rows::next() {
  if (header_.columns().empty()) read_header();
  while (next_row()) {
    if ((needs_value_ || header_.matrix()) && !has_value()) continue;
    read_fields();
    ++rows_;
    return true;
  }
  finish();
  return false;
}

/// Moves to the next line, or to the next cell of a matrix's line.
GONIO_INLINE bool sample_rows::next_row() {
  if (header_.matrix() && cell_ + 1 < header_.columns().size()) {
    ++cell_;
    return true;
  }
  cell_ = 1;
  return csv_.next([this](std::string_view text) { read_comment(text); });
}

/// Does a field of the line belong to the current row? In a matrix, these are the first field and the field of the
/// current cell.
GONIO_INLINE bool sample_rows::is_of_row(std::size_t field) const noexcept {
  return !header_.matrix() || field == 0 || field == cell_;
}

[[gnu::cold]] GONIO_INLINE void sample_rows::read_comment(std::string_view comment) {
  const comment_entry entry = entry_of(comment);
  keep(provenance_, entry);
  read_stated_angle(comment);
  if (entry.key == "theta-o-sign") return read_sign(entry.value);
  if (entry.key == "source-half-angle") return read_half_angle(half_angle_group.first, entry);
  if (entry.key == "receiver-half-angle") return read_half_angle(half_angle_group.first + 1, entry);
  if (entry.key != "quantity") return;
  const text_position& position = csv_.position();
  if (rows_ > 0) position.refuse("the comment with the quantity is below a sample, expected above the first");
  const auto quantity = quantity_named(entry.value);
  if (!quantity)
    position.refuse({"the quantity ", in_quotes(entry.value),
                     " is unknown, expected brdf, brdf-cosine, reflectance-factor or percent"});
  quantity_.state(*quantity, message_of({"the comment in line ", position.line}), position);
}

[[gnu::cold]] GONIO_INLINE void sample_rows::read_sign(std::string_view value) {
  if (value != "light" && value != "mirror")
    csv_.position().refuse({"theta-o-sign ", in_quotes(value), " is unknown, expected light or mirror"});
  const theta_o_sign stated = value == "light" ? theta_o_sign::light : theta_o_sign::mirror;
  if (sign_.value_or(stated) != stated)
    csv_.position().refuse({"the file says theta-o-sign ", value, ", but ",
                            reading_.sign ? "--theta-o-sign contradicts it" : "an earlier line says the other sign"});
  sign_ = stated;
}

/// Sets the half angle of all lines below the comment, unless the file has a column for it.
[[gnu::cold]] GONIO_INLINE void sample_rows::read_half_angle(std::size_t column, const comment_entry& entry) {
  if (const char* wrong = csv_.read_number(entry.value, numbers_[column]); wrong != nullptr)
    csv_.position().refuse({entry.key, ": ", in_quotes(entry.value), wrong, ", expected degrees"});
}

[[gnu::cold]] GONIO_INLINE void sample_rows::read_stated_angle(std::string_view line) {
  const auto found = stated_angle_of(line, columns_named());
  if (!found) return;
  if (header_.columns().empty()) return stated_angles_.push_back(*found);
  // Below the header line, an angle applies to the samples below it.
  for (stated_angle& stated : stated_angles_)
    if (stated.column == found->column) {
      changes_stated_angle_ = changes_stated_angle_ || stated.degrees != found->degrees;
      stated.degrees = found->degrees;
    }
}

[[gnu::cold]] GONIO_INLINE column_finder sample_rows::columns_named() const {
  return [this](std::string_view name) { return find_column(name, reading_); };
}

/// Looks for the header line below a preamble.
[[gnu::cold]] GONIO_INLINE void sample_rows::find_header() {
  if (csv_.find_header([this](const auto& fields) { return name_directions(fields, reading_); })) return;
  if (csv_.find_header([this](const auto& fields) { return name_angle_and_values(fields, reading_); })) return;
  csv_.find_header([this](const auto& fields) { return matrix_of(fields, columns_named()).has_value(); });
}

[[gnu::cold]] GONIO_INLINE void sample_rows::read_header() {
  find_header();
  if (!csv_.next([this](std::string_view text) { read_comment(text); }))
    gonio::refuse({csv_.position().name, ": is empty, expected a header line that names the columns"});
  for (const std::string_view line : csv_.passed_over()) read_stated_angle(line);
  header_.read(csv_, reading_, needs_value_, stated_angles_);
  stated_angles_ = header_.stated();
  cell_ = header_.columns().size();
  quantity_.state(header_.quantity(), csv_.position());
  numbers_.resize(sample_columns.size() + 1 + header_.wavelengths().size());
  if (header_.wavelengths().size() == 1) wavelength_ = header_.wavelengths().front();
}

GONIO_INLINE void sample_rows::read_fields() {
  const std::vector<std::size_t>& columns = header_.columns();
  std::size_t percent_signs = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::size_t column = columns[i];
    const std::string_view field = csv_.fields()[i];
    if (column == sample_header::ignored || !is_of_row(i)) continue;
    if (column == quantity_column)
      read_quantity(field);
    else
      read_number_of(column, field, percent_signs);
  }
  if (const auto& matrix = header_.matrix()) numbers_[matrix->across] = matrix->angles[cell_ - 1];
  for (const stated_angle& stated : stated_angles_) numbers_[stated.column] = stated.degrees;
  for (const std::size_t column : header_.columns_in_radians()) numbers_[column] = degrees(numbers_[column]);
  check_percent_signs(percent_signs);
  check_weights();
  if (header_.has_wavelength()) check_wavelength();
  if (header_.is_in_plane()) look_at_sides();
}

/// Is the field one of the words that instruments and programs write instead of a number?
[[gnu::cold]] [[nodiscard]] GONIO_INLINE bool is_no_value(std::string_view field) {
  constexpr std::array<std::string_view, 42> words{
      "",          "-",         "--",         "---",     "?",         "nan",    "-nan",     "+nan",     "nan(ind)",
      "-nan(ind)", "1.#ind",    "-1.#ind",    "1.#qnan", "1.#inf",    "inf",    "+inf",     "-inf",     "n/a",
      "n.a.",      "na",        "#n/a",       "#nv",     "null",      "none",   "nil",      "missing",  "over",
      "ovr",       "ovl",       "ovf",        "ovfl",    "o.l.",      "ol",     "overflow", "overload", "overrange",
      "under",     "underflow", "underrange", "sat",     "saturated", "#value!"};
  return field.size() <= 10 && std::ranges::find(words, lower_case(field)) != words.end();
}

/// Does the line have a number in every needed column? Counts lines that do not.
GONIO_INLINE bool sample_rows::has_value() {
  const std::vector<std::size_t>& columns = header_.columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string_view field = csv_.fields()[i];
    if (!is_of_row(i) || (!field.empty() && field.back() >= '0' && field.back() <= '9')) continue;
    if (columns[i] == quantity_column || columns[i] == sample_header::ignored || !is_no_value(field)) continue;
    if (++missing_ > 1) return false;
    double number = 0.0;
    const char* wrong = csv_.read_number(field, number);
    first_missing_ = message_of({"no value (line ", csv_.position().line, ": ", in_quotes(field), ")"});
    missing_message_ = message_of(
        {"line ", csv_.position().line, ": column ", header_.name_of(columns[i]), ": ", in_quotes(field), wrong});
    return false;
  }
  return true;
}

GONIO_INLINE std::string_view sample_rows::rows_are_called(std::size_t count) const noexcept {
  if (header_.matrix()) return count == 1 ? "cell" : "cells";
  return count == 1 ? "row" : "rows";
}

GONIO_INLINE void sample_rows::require_values() const {
  const std::size_t all = missing_ + rows_;
  if (2 * missing_ > all)
    gonio::refuse({csv_.position().name, ", ", missing_message_, "; ", missing_, " of ", all, " ", rows_are_called(all),
                   all == 1 ? " has" : " have", " no value, expected at most half; the file looks ",
                   description(csv_.dialect())});
}

GONIO_INLINE void sample_rows::read_number_of(std::size_t column, std::string_view field, std::size_t& percent_signs) {
  const char* wrong = csv_.read_number(field, numbers_[column]);
  if (wrong == nullptr) return;
  if (field.ends_with('%') && header_.values().has(column)) {
    wrong = csv_.read_number(trimmed(field.substr(0, field.size() - 1)), numbers_[column]);
    ++percent_signs;
  } else if (const std::string_view angle = without_degree_sign(field); angle.size() < field.size()) {
    if (is_angle(column)) wrong = csv_.read_number(angle, numbers_[column]);
  }
  if (wrong != nullptr) refuse_number(column, field, wrong);
}

[[gnu::cold]] GONIO_INLINE void sample_rows::refuse_number(std::size_t column, std::string_view field,
                                                           const char* wrong) const {
  csv_.position().refuse({"column ", header_.name_of(column), ": ", in_quotes(field), wrong, "; the file looks ",
                          description(csv_.dialect())});
}

/// Reads the quantity that a line states. All lines must state the same quantity.
[[gnu::cold]] GONIO_INLINE void sample_rows::read_quantity(std::string_view field) {
  const auto quantity = quantity_named(field);
  if (!quantity)
    csv_.position().refuse({"column quantity: ", in_quotes(field),
                            " is unknown, expected brdf, brdf-cosine, reflectance-factor or "
                            "percent"});
  quantity_.state(*quantity, "the column quantity", csv_.position());
}

/// Throws gonio::error unless all values of the file have percent signs or none has.
[[gnu::cold]] GONIO_INLINE void sample_rows::check_percent_signs(std::size_t signs) {
  const std::size_t count = header_.values().count;
  if (rows_ == 0) has_percent_signs_ = signs > 0;
  if (signs != (has_percent_signs_ ? count : 0))
    csv_.position().refuse("some values have percent signs and some have not, expected all or none");
  if (rows_ == 0 && has_percent_signs_) quantity_.state_percent_signs("their percent signs", csv_.position());
}

[[gnu::cold]] GONIO_INLINE void sample_rows::check_wavelength() {
  const double given = numbers_[wavelength_column];
  if (!(given > 0.0)) csv_.position().refuse({"column wavelength: ", shortest(given), " nm, expected more than 0"});
  if (!wavelength_) wavelength_ = given;
  if (*wavelength_ != given)
    csv_.position().refuse(
        {"column wavelength: ", shortest(given), " nm, but ", shortest(*wavelength_),
         " nm above: more than one wavelength in this column is not supported, expected a file for each, or "
         "columns named by their wavelengths, such as 400nm"});
}

GONIO_INLINE void sample_rows::check_weights() const {
  const column_group& weights = header_.weights();
  for (std::size_t column = weights.first; column < weights.first + weights.count; ++column)
    if (numbers_[column] < 0.0)
      csv_.position().refuse(
          {"column ", sample_columns[column], ": ", shortest(numbers_[column]), " is negative, expected at least 0"});
}

/// Without azimuths, a single negative angle in the file shows that signs give the side of the normal.
[[gnu::cold]] GONIO_INLINE void sample_rows::look_at_sides() {
  if (sign_) {
    if (*sign_ == theta_o_sign::mirror) numbers_[angle_group.first + 2] *= -1.0;
    return;
  }
  const double theta_i = numbers_[angle_group.first], theta_o = numbers_[angle_group.first + 2];
  if (theta_i < 0.0 || theta_o < 0.0) has_signed_angle_ = true;
  if (theta_i > 0.0 && theta_o > 0.0 && line_of_unknown_side_ == 0) line_of_unknown_side_ = csv_.position().line;
}

[[gnu::cold]] GONIO_INLINE void sample_rows::finish() const {
  require_values();
  if (rows_ == 0) gonio::refuse({csv_.position().name, ": has a header line but no samples, expected at least one"});
  if (sign_ && header_.directions().first == half_difference_group.first)
    gonio::refuse({csv_.position().name, ": has half vectors, to which theta-o-sign does not apply"});
  if (line_of_unknown_side_ > 0 && !has_signed_angle_)
    text_position{csv_.position().name, line_of_unknown_side_}.refuse(
        "the viewer's side of the normal is unknown: there are no columns phi_i and phi_o, and no angle is negative; "
        "expected these columns, negative angles on one side of the normal, or --theta-o-sign");
  if (reading_.note) note_assumptions();
}

/// Notes assumptions about the file, and its lines and columns that are ignored.
[[gnu::cold]] GONIO_INLINE void sample_rows::note_assumptions() const {
  const std::string& name = csv_.position().name;
  if (const std::size_t lines = csv_.passed_over().size(); lines > 0)
    reading_.note(message_of({name, ": ", lines, lines == 1 ? " line" : " lines", " above the header line ",
                              lines == 1 ? "is" : "are", " not read"}));
  if (const std::string ignored = header_.note_of_ignored(); !ignored.empty())
    reading_.note(message_of({name, ": ", ignored}));
  note_layout();
  if (assumes_side())
    reading_.note(
        message_of({name,
                    ": there are no columns phi_i and phi_o: light and viewer are taken to be on the same side of the "
                    "normal where theta_i and theta_o have the same sign (--theta-o-sign light)"}));
  if (const std::string& relative = header_.relative_azimuth(); !relative.empty() && !sign_)
    reading_.note(message_of({name, ": ", in_quotes(relative),
                              " is read as phi_o - phi_i: 0 degrees on the light's side of the normal, 180 in the "
                              "mirror direction (--theta-o-sign mirror: the other way round)"}));
}

/// Notes angles without a column, and the assumed meaning of X, Y and Z.
[[gnu::cold]] GONIO_INLINE void sample_rows::note_layout() const {
  const std::string& name = csv_.position().name;
  if (const auto& matrix = header_.matrix())
    reading_.note(message_of({name, ": is read as a matrix, ", description(*matrix)}));
  for (const stated_angle& stated : header_.stated())
    reading_.note(message_of({name, ": ", sample_columns[stated.column], " is taken to be ", shortest(stated.degrees),
                              " degrees, as stated above the header line",
                              changes_stated_angle_ ? ", and below it as stated above each block of samples" : ""}));
  if (header_.values().first == tristimulus_group.first)
    reading_.note(message_of({name, ": X, Y and Z are read as CIE tristimulus values under D65"}));
}

}  // namespace gonio::io::detail
