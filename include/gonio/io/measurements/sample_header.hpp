#pragma once
/// The header line of a file of samples: the column of each field, the meaning that names and units give to the
/// numbers, and the columns to ignore. io/measurements/samples.hpp lists the names.

#include <gonio/io/measurements/sample_columns.hpp>
#include <gonio/io/measurements/sample_layout.hpp>
#include <gonio/io/measurements/sample_quantity.hpp>
#include <gonio/io/text/csv_reader.hpp>
#include <gonio/io/text/text.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

/// The name of a column in a file: {"theta_o", "Winkel"}.
struct column_name {
  std::string column, in_file;
};

/// The side of the normal where theta_o is positive if theta_i is positive and the azimuths are equal or missing: the
/// light's side (the mirror direction is at theta_o = -theta_i), or the mirror direction's side (at theta_o = theta_i).
enum class theta_o_sign { light, mirror };

/// The caller's knowledge of a file, and the receiver of notes on it.
struct sample_reading {
  std::vector<column_name> columns = {};              ///< names are compared without regard to case
  std::optional<sample_quantity> quantity = {};       ///< needed if the file does not state it
  std::function<void(const std::string&)> note = {};  ///< receives sentences on ignored columns and on assumptions
  std::optional<theta_o_sign> sign = {};              ///< for files that do not state it
};

namespace detail {

/// Returns the column that has this name by default or in `reading`; `sample_header::ignored` if there is none.
[[nodiscard]] std::size_t find_column(std::string_view name, const sample_reading& reading);

/// Do the fields name at least two columns of directions? Then the line is a header line.
[[nodiscard]] bool name_directions(std::span<const std::string_view> fields, const sample_reading& reading);

/// Do the fields name an angle and values? If no line satisfies `name_directions`, such a line is the header line.
[[nodiscard]] bool name_angle_and_values(std::span<const std::string_view> fields, const sample_reading& reading);

class sample_header {
 public:
  /// The column number of a field that belongs to no known column.
  static constexpr std::size_t ignored = sample_columns.size();

  /// Reads the file's current line. If a line of units is below it, moves the file to that line and reads it, too.
  /// `stated` has the angles stated above the header line; those without a column apply to all samples.
  void read(csv_reader& file, const sample_reading& reading, bool needs_value, std::span<const stated_angle> stated);

  [[nodiscard]] const std::vector<std::size_t>& columns() const noexcept { return columns_; }
  [[nodiscard]] const column_group& directions() const noexcept { return directions_; }
  /// Returns the columns of r,g,b, of X,Y,Z, of a single value, or of the wavelengths, which are numbered from
  /// `ignored` + 1; the count is 0 if there are none.
  [[nodiscard]] const column_group& values() const noexcept { return values_; }
  /// Returns the matrix, if the file is one: fields after the first are values at the angles of their line and column.
  [[nodiscard]] const std::optional<sample_matrix>& matrix() const noexcept { return matrix_; }
  /// Returns the angles that have no column because they are stated for all samples.
  [[nodiscard]] const std::vector<stated_angle>& stated() const noexcept { return stated_; }
  /// Returns the wavelengths of columns named by their wavelength, nanometres, ascending.
  [[nodiscard]] const std::vector<double>& wavelengths() const noexcept { return wavelengths_; }
  /// Returns the name of a column in messages.
  [[nodiscard]] std::string name_of(std::size_t column) const;
  /// Returns the columns of a sample's weight: one, or one for each channel.
  [[nodiscard]] const column_group& weights() const noexcept { return weights_; }
  [[nodiscard]] bool has_wavelength() const noexcept { return has_wavelength_; }
  /// Are there polar angles without azimuths? Their signs give the side of the normal.
  [[nodiscard]] bool is_in_plane() const noexcept { return is_in_plane_; }
  /// Returns the file's name for a column of phi_o - phi_i, which replaces both azimuths; empty if it has none.
  [[nodiscard]] const std::string& relative_azimuth() const noexcept { return relative_azimuth_; }
  [[nodiscard]] const std::vector<std::size_t>& columns_in_radians() const noexcept { return in_radians_; }
  /// Returns the quantity that the columns' names and units state.
  [[nodiscard]] const stated_quantity& quantity() const noexcept { return quantity_; }
  /// Returns a sentence on the columns that are ignored; empty if there are none.
  [[nodiscard]] std::string note_of_ignored() const;

 private:
  void add(const written_column& written, const sample_reading& reading, const text_position& position);
  [[nodiscard]] bool add_known(const written_column& written, const known_name& known, const text_position& position);
  [[nodiscard]] bool add_wavelength(const written_column& written, const text_position& position);
  void require_named(const sample_reading& reading, const text_position& position) const;
  void read_matrix(const std::vector<written_column>& names, const text_position& position);
  void find_stated(std::span<const stated_angle> stated, const text_position& position);
  void find_directions(const text_position& position);
  void find_values(bool needs_value, const text_position& position);
  void use_r_as_value(const text_position& position);
  void ignore_tristimulus(const std::vector<written_column>& names);
  void find_weights(const text_position& position);
  [[nodiscard]] bool has(std::size_t column) const { return has_any({column, 1}); }
  [[nodiscard]] bool knows(std::size_t column) const;
  [[nodiscard]] bool has_any(const column_group& group) const;
  void require(const column_group& group, const text_position& position) const;
  [[noreturn]] void refuse_missing(std::size_t column, const text_position& position) const;
  [[nodiscard]] std::string as_it_looks() const;

  csv_dialect dialect_;
  std::vector<std::size_t> columns_, in_radians_;
  std::vector<double> wavelengths_;
  std::vector<written_column> extra_;
  std::optional<sample_matrix> matrix_;
  std::vector<stated_angle> stated_;
  column_group directions_, values_, weights_ = weight_group;
  stated_quantity quantity_;
  std::string relative_azimuth_;
  bool is_in_plane_ = false, has_wavelength_ = false;
};

}  // namespace detail

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/sample_header.ipp>
#endif
