#pragma once
/// The header line of a file of samples: which column each field of a line is, what the columns' names and units say of
/// the numbers, and which columns are not needed. io/measurements/samples.hpp has the names.

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

/// A column that a file calls otherwise: {"theta_o", "Winkel"}.
struct column_name {
  std::string column, in_file;
};

/// Where theta_o is positive, theta_i being positive and azimuths, if there are any, equal: on the light's side of the
/// normal, so that the mirror direction is at theta_o = -theta_i, or on the mirror direction's side.
enum class theta_o_sign { light, mirror };

/// What the reader of a file is told beside it.
struct sample_reading {
  std::vector<column_name> columns = {};              ///< compared in letters of either case
  std::optional<sample_quantity> quantity = {};       ///< needed where the file does not say it
  std::function<void(const std::string&)> note = {};  ///< is told in a sentence what is ignored or assumed
  std::optional<theta_o_sign> sign = {};              ///< of files that do not say it
};

namespace detail {

/// The column that the file's reader, or anybody, calls so; `sample_header::ignored` if there is none.
[[nodiscard]] std::size_t find_column(std::string_view name, const sample_reading& reading);

/// Do the fields of a line name at least two columns of directions? Then it is a header line.
[[nodiscard]] bool name_directions(std::span<const std::string_view> fields, const sample_reading& reading);

/// Do they name an angle and values? Of a file without such a line as above, it is the header line.
[[nodiscard]] bool name_angle_and_values(std::span<const std::string_view> fields, const sample_reading& reading);

class sample_header {
 public:
  /// Of a field that is no column of samples.
  static constexpr std::size_t ignored = sample_columns.size();

  /// Of the line that the file is at, and of the line of units below it, if there is one, to which the file then turns.
  /// `stated` is what lines above it say of angles, and counts for those that have no column.
  void read(csv_reader& file, const sample_reading& reading, bool needs_value, std::span<const stated_angle> stated);

  [[nodiscard]] const std::vector<std::size_t>& columns() const noexcept { return columns_; }
  [[nodiscard]] const column_group& directions() const noexcept { return directions_; }
  /// r,g,b or the one value, or the wavelengths, which are counted from `ignored` + 1 on; the count is 0 if there is
  /// none of these.
  [[nodiscard]] const column_group& values() const noexcept { return values_; }
  /// Each field behind the first is a value, whose angles are its line's and its column's.
  [[nodiscard]] const std::optional<sample_matrix>& matrix() const noexcept { return matrix_; }
  /// Angles of all samples, which have no column.
  [[nodiscard]] const std::vector<stated_angle>& stated() const noexcept { return stated_; }
  /// Of columns that are called by theirs, nanometres, ascending.
  [[nodiscard]] const std::vector<double>& wavelengths() const noexcept { return wavelengths_; }
  /// What a column is called in messages.
  [[nodiscard]] std::string name_of(std::size_t column) const;
  /// The columns that say how much a sample counts: one, or one for each channel.
  [[nodiscard]] const column_group& weights() const noexcept { return weights_; }
  [[nodiscard]] bool has_wavelength() const noexcept { return has_wavelength_; }
  /// Polar angles without azimuths: their signs say which side of the normal a direction is on.
  [[nodiscard]] bool is_in_plane() const noexcept { return is_in_plane_; }
  /// What the file calls a column of phi_o - phi_i, which stands for both azimuths; empty if it has none.
  [[nodiscard]] const std::string& relative_azimuth() const noexcept { return relative_azimuth_; }
  [[nodiscard]] const std::vector<std::size_t>& columns_in_radians() const noexcept { return in_radians_; }
  /// What the columns' names and units say that the values are.
  [[nodiscard]] const stated_quantity& quantity() const noexcept { return quantity_; }
  /// A sentence on the columns that are no columns of samples; empty if there are none.
  [[nodiscard]] std::string note_of_ignored() const;

 private:
  void add(const written_column& written, const sample_reading& reading, const text_place& place);
  [[nodiscard]] bool add_known(const written_column& written, const known_name& known, const text_place& place);
  [[nodiscard]] bool add_wavelength(const written_column& written, const text_place& place);
  void require_named(const sample_reading& reading, const text_place& place) const;
  void read_matrix(const std::vector<written_column>& names, const text_place& place);
  void find_stated(std::span<const stated_angle> stated);
  void find_directions(const text_place& place);
  void find_values(bool needs_value, const text_place& place);
  void take_r_for_value(const text_place& place);
  void ignore_tristimulus(const std::vector<written_column>& names);
  void find_weights(const text_place& place);
  [[nodiscard]] bool has(std::size_t column) const { return has_any({column, 1}); }
  [[nodiscard]] bool knows(std::size_t column) const;
  [[nodiscard]] bool has_any(const column_group& group) const;
  void require(const column_group& group, const text_place& place) const;
  [[noreturn]] void refuse_missing(std::size_t column, const text_place& place) const;
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
