#pragma once
/// The lines of a file of samples or directions, or the cells of a matrix, as numbers by column.
/// io/measurements/samples.hpp converts them to directions and values.

#include <gonio/io/measurements/sample_header.hpp>
#include <gonio/io/measurements/sample_layout.hpp>
#include <gonio/io/measurements/sample_provenance.hpp>
#include <gonio/io/measurements/sample_quantity.hpp>
#include <gonio/io/text/csv_dialect.hpp>
#include <gonio/io/text/csv_reader.hpp>
#include <gonio/io/text/text.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// Numbers by column; wavelengths come after `sample_header::ignored`.
using sample_row = std::vector<double>;

/// The numbers of a line or of a matrix's cell, and how to read them.
struct row_view {
  const sample_row& numbers;
  const column_group& group;  ///< the columns of the directions
  const column_group& values;
  const column_group& weights;
  std::optional<sample_quantity> quantity;
  const text_position& position;
  const sample_header& header;

  [[nodiscard]] bool has_half_difference() const noexcept { return group.first == half_difference_group.first; }
};

/// Reads a file of samples or directions line by line:
/// `sample_rows rows(text, name, false, {}); while (rows.next()) use(rows.row());`
class sample_rows {
 public:
  sample_rows(std::string_view text, const std::string& name, bool needs_value, const sample_reading& reading);

  /// Moves to the next line of numbers, or to the next cell of a matrix. Returns false at the end of the file. Throws
  /// gonio::error for a file without a line of numbers. Skips cells without a value ("n/a", "OVER") and, if values are
  /// needed, lines without a value.
  [[nodiscard]] bool next();

  /// Returns the number of lines or cells without a value; `first_without_value` describes the first of them, as in
  /// "no value (line 92: 'OVER')".
  [[nodiscard]] std::size_t rows_without_value() const noexcept { return missing_; }
  [[nodiscard]] const std::string& first_without_value() const noexcept { return first_missing_; }
  /// Returns "row" or "rows", for a matrix "cell" or "cells".
  [[nodiscard]] std::string_view rows_are_called(std::size_t count) const noexcept;
  /// Throws gonio::error if more than half of the lines have no value.
  void require_values() const;

  [[nodiscard]] row_view row() const noexcept {
    return {numbers_, header_.directions(), header_.values(), header_.weights(), quantity_.quantity(), csv_.position(),
            header_};
  }
  [[nodiscard]] const sample_header& header() const noexcept { return header_; }
  /// Returns separator and decimal mark in words.
  [[nodiscard]] std::string dialect() const { return description(csv_.dialect()); }
  [[nodiscard]] std::optional<sample_quantity> quantity() const noexcept { return quantity_.quantity(); }
  [[nodiscard]] std::optional<double> wavelength() const noexcept { return wavelength_; }
  [[nodiscard]] const sample_provenance& provenance() const noexcept { return provenance_; }
  /// Does the file lack both azimuths and a statement of the side of the normal on which theta_o is positive?
  [[nodiscard]] bool assumes_side() const noexcept { return header_.is_in_plane() && !sign_; }
  [[nodiscard]] const std::optional<theta_o_sign>& sign() const noexcept { return sign_; }
  /// Are azimuths counted from the mirror direction? Without azimuths, this class changes the sign of theta_o instead.
  [[nodiscard]] bool turns_viewers() const noexcept { return !header_.is_in_plane() && sign_ == theta_o_sign::mirror; }

 private:
  void read_comment(std::string_view comment);
  [[nodiscard]] column_finder columns_named() const;
  void find_header();
  void read_header();
  void read_stated_angle(std::string_view line);
  [[nodiscard]] bool next_row();
  [[nodiscard]] bool is_of_row(std::size_t field) const noexcept;
  void read_fields();
  [[nodiscard]] bool has_value();
  void read_number_of(std::size_t column, std::string_view field, std::size_t& percent_signs);
  [[noreturn]] void refuse_number(std::size_t column, std::string_view field, const char* wrong) const;
  void read_quantity(std::string_view field);
  void check_percent_signs(std::size_t signs);
  void check_wavelength();
  void check_weights() const;
  void read_sign(std::string_view value);
  void read_half_angle(std::size_t column, const comment_entry& entry);
  void look_at_sides();
  void finish() const;
  void note_assumptions() const;
  void note_layout() const;

  csv_reader csv_;
  bool needs_value_;
  const sample_reading& reading_;
  sample_header header_;
  stated_quantity quantity_;
  sample_provenance provenance_;
  std::optional<double> wavelength_;
  std::optional<theta_o_sign> sign_;
  sample_row numbers_ = sample_row(sample_columns.size());
  std::vector<stated_angle> stated_angles_;  ///< those above the header line, then those of the current sample
  bool changes_stated_angle_ = false;
  std::size_t cell_ = 0;  ///< the field of the current cell in a matrix's line
  std::size_t rows_ = 0, missing_ = 0;
  std::string first_missing_, missing_message_;
  bool has_percent_signs_ = false, has_signed_angle_ = false;
  std::size_t line_of_unknown_side_ = 0;  ///< first line with two positive polar angles
};

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/sample_rows.ipp>
#endif
