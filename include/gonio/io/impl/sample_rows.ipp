#pragma once
/// Bodies of io/sample_rows.hpp. What is done once for a file is cold: compilers then do not spend seconds on making it
/// fast.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/csv_dialect.hpp>
#include <gonio/io/sample_header.hpp>
#include <gonio/io/sample_provenance.hpp>
#include <gonio/io/sample_quantity.hpp>
#include <gonio/io/sample_rows.hpp>
#include <gonio/io/text.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

[[gnu::cold]] GONIO_INLINE row_reader::row_reader(std::string_view text, const std::string& name, bool needs_value,
                                                  const sample_reading& reading)
    : left_(without_byte_order_mark(text)), place_{name, 0}, needs_value_(needs_value), reading_(reading) {
  require_plain_text(text, name);
  numbers_[weight_group.first] = 1.0;
  if (reading.quantity) quantity_.state(*reading.quantity, "what is asked for (--quantity)", place_);
}

GONIO_INLINE bool row_reader::next() {
  std::string_view line;
  if (header_.columns().empty()) {
    if (!next_line(line)) gonio::refuse({place_.name, ": is empty, expected a header line that names the columns"});
    read_header(line);
  }
  if (next_line(line)) {
    read_fields(line);
    ++rows_;
    return true;
  }
  finish();
  return false;
}

/// The next line that is neither empty, nor a comment, nor separators alone. A spreadsheet puts a comment in quotes;
/// below the header line that is a field.
GONIO_INLINE bool row_reader::next_line(std::string_view& line) {
  while (next_whole_line(left_, place_, line)) {
    const std::size_t first = line.find_first_not_of(blanks);
    const bool in_quotes = header_.columns().empty() && line.substr(first).starts_with("\"# ");
    if (in_quotes || line[first] == '#') {
      read_comment(line.substr(first + (in_quotes ? 2 : 1)));
      continue;
    }
    if ((line[first] != ',' && line[first] != ';') || line.find_first_not_of(",; \t\r") != std::string_view::npos)
      return true;
  }
  return false;
}

[[gnu::cold]] GONIO_INLINE void row_reader::read_comment(std::string_view comment) {
  const std::size_t last = comment.find_last_not_of(",;\" \t\r");  // what a spreadsheet puts behind
  const comment_entry entry = entry_of(comment.substr(0, last == std::string_view::npos ? 0 : last + 1));
  keep(provenance_, entry);
  if (entry.key != "quantity") return;
  if (rows_ > 0) place_.refuse("the comment on the quantity stands below a sample, expected above the first");
  const auto quantity = quantity_named(entry.value);
  if (!quantity)
    place_.refuse({"the quantity ", quoted(entry.value),
                   " is unknown, expected brdf, brdf-cosine, reflectance-factor or percent"});
  quantity_.state(*quantity, message_of({"the comment in line ", place_.line}), place_);
}

[[gnu::cold]] GONIO_INLINE void row_reader::read_header(std::string_view line) {
  dialect_ = dialect_of(line);
  header_.read(line, dialect_, reading_, needs_value_, place_);
  quantity_.state(header_.quantity(), place_);
  numbers_.resize(sample_columns.size() + 1 + header_.wavelengths().size());
  if (header_.wavelengths().size() == 1) wavelength_ = header_.wavelengths().front();
}

GONIO_INLINE void row_reader::read_fields(std::string_view line) {
  const std::vector<std::size_t>& columns = header_.columns();
  if (const char* wrong = split_fields(line, dialect_, fields_)) place_.refuse(wrong);
  while (fields_.size() > columns.size() && fields_.back().empty()) fields_.pop_back();
  if (fields_.size() != columns.size()) refuse_size(line);
  std::size_t percent_signs = 0;
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    const std::size_t column = columns[i];
    // A plain number with a decimal point, which nearly all are, is read at once.
    const bool is_number = column < quantity_column || column > sample_header::ignored;
    if (is_number && dialect_.decimal_mark == '.' && read_number(fields_[i], numbers_[column]) == nullptr) continue;
    if (is_number)
      read_number_of(column, fields_[i], percent_signs);
    else if (column == quantity_column)
      read_quantity(fields_[i]);
  }
  for (const std::size_t column : header_.columns_in_radians()) numbers_[column] = degrees(numbers_[column]);
  check_percent_signs(percent_signs);
  check_weights();
  if (header_.has_wavelength()) check_wavelength();
  if (header_.is_in_plane()) look_at_sides();
}

[[gnu::cold]] GONIO_INLINE void row_reader::read_number_of(std::size_t column, std::string_view field,
                                                           std::size_t& percent_signs) {
  const char* wrong = read_number(field, dialect_, numbers_[column]);
  if (wrong == nullptr) return;
  if (field.ends_with('%') && header_.values().has(column)) {
    wrong = read_number(trimmed(field.substr(0, field.size() - 1)), dialect_, numbers_[column]);
    ++percent_signs;
  }
  if (wrong != nullptr)
    place_.refuse(
        {"column ", header_.name_of(column), ": ", quoted(field), wrong, "; the file looks ", description(dialect_)});
}

/// The file may say in each line what its numbers are, if it is the same in all.
[[gnu::cold]] GONIO_INLINE void row_reader::read_quantity(std::string_view field) {
  const auto quantity = quantity_named(field);
  if (!quantity)
    place_.refuse({"column quantity: ", quoted(field),
                   " is unknown, expected brdf, brdf-cosine, reflectance-factor or "
                   "percent"});
  quantity_.state(*quantity, "the column quantity", place_);
}

/// Values have percent signs everywhere or nowhere.
[[gnu::cold]] GONIO_INLINE void row_reader::check_percent_signs(std::size_t signs) {
  const std::size_t count = header_.values().count;
  if (rows_ == 0) has_percent_signs_ = signs > 0;
  if (signs != (has_percent_signs_ ? count : 0))
    place_.refuse("some values have percent signs and some have not, expected all or none");
  if (rows_ == 0 && has_percent_signs_) quantity_.state_percent_signs("their percent signs", place_);
}

[[gnu::cold]] GONIO_INLINE void row_reader::check_wavelength() {
  const double given = numbers_[wavelength_column];
  if (!(given > 0.0)) place_.refuse({"column wavelength: ", shortest(given), " nm, expected more than 0"});
  if (!wavelength_) wavelength_ = given;
  if (*wavelength_ != given)
    place_.refuse({"column wavelength: ", shortest(given), " nm, but ", shortest(*wavelength_),
                   " nm above: more than one wavelength in such a column is not read, expected a file for each, or "
                   "columns called by their wavelengths, as 400nm"});
}

GONIO_INLINE void row_reader::check_weights() const {
  const column_group& weights = header_.weights();
  for (std::size_t column = weights.first; column < weights.first + weights.count; ++column)
    if (numbers_[column] < 0.0)
      place_.refuse(
          {"column ", sample_columns[column], ": ", shortest(numbers_[column]), " is negative, expected at least 0"});
}

/// Without azimuths, one negative angle in the file shows that signs tell the sides of the normal apart.
[[gnu::cold]] GONIO_INLINE void row_reader::look_at_sides() {
  const double theta_i = numbers_[angle_group.first], theta_o = numbers_[angle_group.first + 2];
  if (theta_i < 0.0 || theta_o < 0.0) has_signed_angle_ = true;
  if (theta_i > 0.0 && theta_o > 0.0 && line_of_unknown_side_ == 0) line_of_unknown_side_ = place_.line;
}

[[gnu::cold]] GONIO_INLINE void row_reader::finish() const {
  if (rows_ == 0) gonio::refuse({place_.name, ": has a header line but no samples, expected at least one"});
  if (line_of_unknown_side_ > 0 && !has_signed_angle_)
    text_place{place_.name, line_of_unknown_side_}.refuse(
        "on which sides of the normal are light and viewer? There are no columns phi_i and phi_o, and no angle of the "
        "file is negative; expected these columns, or signs: those of one side are equal");
  if (!reading_.note) return;
  if (const std::string ignored = header_.note_of_ignored(); !ignored.empty())
    reading_.note(message_of({place_.name, ": ", ignored}));
  if (header_.is_in_plane())
    reading_.note(
        message_of({place_.name,
                    ": there are no columns phi_i and phi_o: light and viewer are taken to be on the same side of the "
                    "normal where theta_i and theta_o have the same sign"}));
}

[[gnu::cold]] GONIO_INLINE void row_reader::refuse_size(std::string_view line) const {
  const csv_dialect of_line = dialect_of(line);
  const std::size_t found = fields_.size(), expected = header_.columns().size();
  const bool differs = of_line.separator != dialect_.separator;
  const bool may_have_commas = !differs && dialect_.separator == ',' && found > expected;
  place_.refuse({found, found == 1 ? " field" : " fields", ", expected ", expected,
                 " as in the header line; the header line looks ", description({dialect_.separator}),
                 differs ? ", this one " : "", differs ? description(of_line) : "",
                 may_have_commas ? ": separate fields by semicolons if numbers have decimal commas" : ""});
}

}  // namespace gonio::io::detail
