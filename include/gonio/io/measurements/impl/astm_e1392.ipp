#pragma once
/// Bodies of io/measurements/astm_e1392.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/astm_e1392.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// Reads a file line by line.
class astm_reader {
 public:
  explicit astm_reader(text_position& position) : position_(position) {}

  void read(std::string_view line);

  /// Returns the samples read. Throws gonio::error if the measurement is incomplete.
  [[nodiscard]] sample_collector samples() &&;

 private:
  void read_keyword(std::string_view line);
  void read_variables(std::string_view names);
  [[nodiscard]] sample_collector collector_of(const std::vector<std::string_view>& names) const;
  void read_row(std::string_view line);
  [[nodiscard]] direction read_direction(std::size_t angle) const;
  [[nodiscard]] double number(std::size_t column) const;

  static constexpr std::array<std::string_view, 4> angle_names{"theta_i", "phi_i", "theta_s", "phi_s"};

  text_position& position_;
  std::optional<double> points_;
  std::array<std::size_t, 4> angles_{};  ///< columns of the angles
  std::vector<std::size_t> values_;      ///< columns of the values
  std::vector<std::string> names_;
  std::vector<std::string_view> fields_;
  std::vector<double> reflectances_;
  std::size_t rows_ = 0;
  std::optional<sample_collector> collector_;
};

GONIO_INLINE void astm_reader::read(std::string_view line) {
  if (collector_)
    read_row(line);
  else
    read_keyword(line);
}

GONIO_INLINE sample_collector astm_reader::samples() && {
  if (!collector_) gonio::refuse({position_.name, ": ends before its line VARS, which names the columns"});
  if (points_ && *points_ != static_cast<double>(rows_))
    gonio::refuse({position_.name, ": has ", rows_, " lines of numbers, expected NUM_POINTS ", shortest(*points_)});
  return *std::move(collector_);
}

GONIO_INLINE void astm_reader::read_keyword(std::string_view line) {
  const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
  const std::string_view keyword = line.substr(0, end), value = trimmed(line.substr(end));
  if (keyword == "NUM_POINTS") points_ = read_number(value, position_, [] { return "NUM_POINTS"; });
  if (keyword == "VARS") read_variables(value);
}

GONIO_INLINE void astm_reader::read_variables(std::string_view names) {
  std::vector<std::string_view> all, of_values;
  split_fields(names, all);
  for (std::size_t angle = 0; angle < angle_names.size(); ++angle) {
    if (std::ranges::count(all, angle_names[angle]) != 1)
      position_.refuse({"VARS: expected one column ", angle_names[angle], " in ", in_quotes(names)});
    angles_[angle] = std::ranges::find(all, angle_names[angle]) - all.begin();
  }
  for (std::size_t column = 0; column < all.size(); ++column) {
    names_.emplace_back(all[column]);
    if (std::ranges::find(angle_names, all[column]) != angle_names.end()) continue;
    values_.push_back(column);
    of_values.push_back(all[column]);
  }
  if (values_.empty()) position_.refuse("VARS: expected a column of values besides the angles");
  collector_ = collector_of(of_values);
}

GONIO_INLINE sample_collector astm_reader::collector_of(const std::vector<std::string_view>& names) const {
  const auto are = [&](std::string_view a, std::string_view b, std::string_view c) {
    return names.size() == 3 && names[0] == a && names[1] == b && names[2] == c;
  };
  if (are("R", "G", "B")) return sample_collector(channels());
  if (are("X", "Y", "Z")) return sample_collector::of_xyz();
  std::vector<double> wavelengths;
  for (const std::string_view name : names) {
    double wavelength = 0.0;
    const bool is_wavelength =
        name.ends_with("nm") && read_number(name.substr(0, name.size() - 2), wavelength) == nullptr;
    if (!is_wavelength && names.size() == 1 && !name.empty()) return sample_collector();
    if (!is_wavelength)
      position_.refuse(
          {"VARS: ", in_quotes(name), ", expected one value, or R,G,B, or X,Y,Z, or wavelengths like 400nm"});
    wavelengths.push_back(wavelength);
  }
  try {
    return sample_collector(channels(wavelengths));
  } catch (const error& reason) {
    position_.refuse({"VARS: ", reason.what()});
  }
}

GONIO_INLINE double astm_reader::number(std::size_t column) const {
  return read_number(fields_[column], position_,
                     [&] { return "column " + in_quotes(std::string_view(names_[column])); });
}

GONIO_INLINE direction astm_reader::read_direction(std::size_t angle) const {
  const double theta = number(angles_[angle]), phi = number(angles_[angle + 1]);
  // pi / 2 rounded to four digits may be slightly larger than pi / 2.
  if (!(theta >= 0.0 && theta < std::numbers::pi / 2.0 + 1e-3))
    position_.refuse({"column '", angle_names[angle], "': ", shortest(theta), ", expected radians from 0 to pi / 2",
                      theta > 1.6 && theta <= 90.0 ? "; are these degrees?" : ""});
  if (!(std::abs(phi) < 6.3))
    position_.refuse(
        {"column '", angle_names[angle + 1], "': ", shortest(phi), ", expected radians from -2 pi to 2 pi"});
  return spherical_direction(theta, phi);
}

GONIO_INLINE void astm_reader::read_row(std::string_view line) {
  split_fields(line, fields_);
  if (fields_.size() != names_.size())
    position_.refuse({fields_.size(), " fields, expected ", names_.size(), " as in the line VARS"});
  reflectances_.clear();
  for (const std::size_t column : values_) {
    reflectances_.push_back(number(column));
    require_float_range(reflectances_.back(), position_);
  }
  collector_->add({read_direction(0), read_direction(2)}, reflectances_);
  ++rows_;
}

[[nodiscard]] GONIO_INLINE sample_collector collect_astm(std::string_view text, const std::string& name) {
  text_position position{name, 0};
  astm_reader reader(position);
  for_each_line(text, position, [&](std::string_view line) { reader.read(line); });
  return std::move(reader).samples();
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE bool looks_like_astm_e1392(std::string_view text) {
  text = without_byte_order_mark(text).substr(0, 4096);
  text_position position;
  for (std::string_view line; next_line(text, position, line);)
    if ((line.starts_with("VARS ") || line.starts_with("VARS\t")) && line.find("theta_i") != std::string_view::npos)
      return true;
  return false;
}

GONIO_INLINE sample_set read_astm_e1392(std::string_view text, const std::string& name) {
  return detail::collect_astm(text, name).samples(name);
}

GONIO_INLINE sample_set read_astm_e1392(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_astm_e1392(as_text(bytes), path.string());
}

}  // namespace gonio::io
