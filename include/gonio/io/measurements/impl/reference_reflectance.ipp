#pragma once
/// Bodies of io/measurements/reference_reflectance.hpp.

#include <gonio/capture/reference_reflectance.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/reference_reflectance.hpp>
#include <gonio/io/measurements/sample_header.hpp>
#include <gonio/io/text/csv_reader.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

// The columns. The numbers below are indices into this list.
inline constexpr std::array<std::string_view, 6> reflectance_columns{"theta_i",  "theta_o",  "factor",
                                                                     "factor_r", "factor_g", "factor_b"};
using reflectance_row = std::array<double, reflectance_columns.size()>;

/// The reader's state: the column of each field of a line, and the table so far.
class reflectance_table {
 public:
  void read_header(const csv_reader& file);
  void read_row(csv_reader& file);

  [[nodiscard]] capture::reference_reflectance table() const;

 private:
  struct scaled_column {
    std::size_t column;
    double scale;  ///< converts the column's numbers to degrees, or from per cent
  };

  [[nodiscard]] static std::optional<scaled_column> column_of(const written_column& written);
  [[nodiscard]] bool has(std::size_t column) const {
    return std::ranges::count(columns_, column, &scaled_column::column) > 0;
  }
  void add_angles(double theta_i, double theta_o, const text_position& position);

  std::vector<scaled_column> columns_;
  std::vector<double> theta_i_, theta_o_;  ///< degrees
  std::vector<rgb> factors_;
};

GONIO_INLINE std::optional<reflectance_table::scaled_column> reflectance_table::column_of(
    const written_column& written) {
  const std::size_t column = std::ranges::find(reflectance_columns, written.name) - reflectance_columns.begin();
  const column_unit unit = unit_named(written.unit);
  const bool is_angle = column < 2;
  if (column == reflectance_columns.size()) return {};
  if (unit == column_unit::none || (is_angle && unit == column_unit::degrees)) return scaled_column{column, 1.0};
  if (is_angle && unit == column_unit::radians) return scaled_column{column, degrees(1.0)};
  if (!is_angle && unit == column_unit::percent) return scaled_column{column, 0.01};
  return {};
}

GONIO_INLINE void reflectance_table::read_header(const csv_reader& file) {
  const text_position& position = file.position();
  for (const std::string_view field : file.fields()) {
    const auto found = column_of(written(field));
    if (!found)
      position.refuse({"column ", in_quotes(field),
                       " is unknown, expected theta_i, perhaps theta_o, and factor or "
                       "factor_r,factor_g,factor_b; the header line looks ",
                       description(file.dialect())});
    if (has(found->column)) position.refuse({"column ", in_quotes(field), " appears twice"});
    columns_.push_back(*found);
  }
  const bool has_channels = has(3) || has(4) || has(5);
  if (has_channels && has(2))
    position.refuse("factors are given in two ways, expected factor or factor_r,factor_g,factor_b");
  for (const std::size_t column : {0, 2, 3, 4, 5}) {
    const bool is_needed = column == 0 || (column > 2) == has_channels;
    if (is_needed && !has(column)) position.refuse({"column '", reflectance_columns[column], "' is missing"});
  }
}

GONIO_INLINE void reflectance_table::read_row(csv_reader& file) {
  reflectance_row row{};
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const auto [column, scale] = columns_[i];
    if (const char* wrong = file.read_number(file.fields()[i], row[column]))
      file.position().refuse({"column ", reflectance_columns[column], ": ", in_quotes(file.fields()[i]), wrong});
    row[column] *= scale;
  }
  add_angles(row[0], row[1], file.position());
  factors_.push_back(has(2) ? rgb::Constant(row[2]) : rgb(row[3], row[4], row[5]));
}

/// The lines of the first theta_i determine the list of theta_o, which every theta_i must have.
GONIO_INLINE void reflectance_table::add_angles(double theta_i, double theta_o, const text_position& position) {
  const std::size_t number = factors_.size();
  if (!has(1)) return theta_i_.push_back(theta_i);
  if (number == 0) theta_i_.push_back(theta_i);
  if (theta_i_.size() == 1 && theta_i == theta_i_.front()) return theta_o_.push_back(theta_o);
  const std::size_t column = number % theta_o_.size();
  if (column == 0) theta_i_.push_back(theta_i);
  if (theta_i != theta_i_.back() || theta_o != theta_o_[column])
    position.refuse({"theta_i ", shortest(theta_i), " and theta_o ", shortest(theta_o), ", expected ",
                     shortest(theta_i_.back()), " and ", shortest(theta_o_[column]),
                     ": every theta_i must have the same list of theta_o, in the same order"});
}

GONIO_INLINE capture::reference_reflectance reflectance_table::table() const {
  const auto in_radians = [](std::vector<double> angles) {
    for (double& angle : angles) angle = radians(angle);
    return angles;
  };
  return {in_radians(theta_i_), in_radians(theta_o_), factors_};
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE capture::reference_reflectance read_reference_reflectance(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  csv_reader file(as_text(bytes), path.string());
  detail::reflectance_table read;
  if (file.next()) read.read_header(file);
  while (file.next()) read.read_row(file);
  try {
    return read.table();
  } catch (const error& unusable) {
    gonio::refuse({path.string(), ": ", unusable.what()});
  }
}

}  // namespace gonio::io
