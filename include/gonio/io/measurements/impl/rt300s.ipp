#pragma once
/// Bodies of io/measurements/rt300s.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/rt300s.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/text/csv_reader.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
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

inline constexpr std::string_view rt300s_type = "BRDF(RT-300S)";

/// The directions of light and receiver, degrees.
struct rt300s_pose {
  double azimuth = 0.0, incidence = 0.0, receiver = 0.0;
};

/// Adds a reading; `scale` converts it to RT.
GONIO_INLINE void add_reading(sample_collector& to, const rt300s_pose& pose, double value, double scale,
                              const text_position& position) {
  const direction wi = spherical_direction(radians(pose.incidence), 0.0),
                  wo = spherical_direction(radians(pose.receiver), radians(pose.azimuth - 90.0));
  if (!is_above_horizon(wi) || !is_above_horizon(wo)) return;
  const double reflectance = scale * value * std::numbers::inv_pi / wo.z();
  require_float_range(reflectance, position);
  to.add({wi, wo}, {&reflectance, 1});
}

// ---- text of the type BRDF(RT-300S) --------------------------------------------------------------------------------

class rt300s_reader {
 public:
  rt300s_reader(std::string_view text, text_position& position)
      : text_(without_byte_order_mark(text)), position_(position) {}

  [[nodiscard]] sample_collector read();

 private:
  [[nodiscard]] bool next();
  void read_line();
  void read_receivers();
  void read_row();
  [[nodiscard]] double angle(std::string_view field, std::string_view what, double lowest, double highest) const;

  std::string_view text_;
  text_position& position_;
  std::vector<std::string_view> fields_;
  std::optional<double> incidence_;
  std::vector<double> receivers_;  ///< degrees, for each column
  bool is_in_table_ = false, has_type_ = false;
  sample_collector collector_;
};

/// Moves to the next line that is not blank, and drops empty fields at its end.
GONIO_INLINE bool rt300s_reader::next() {
  std::string_view line;
  if (!next_whole_line(text_, position_, line)) return false;
  split_fields(line, fields_, '\t');
  while (fields_.size() > 1 && fields_.back().empty()) fields_.pop_back();
  return true;
}

GONIO_INLINE double rt300s_reader::angle(std::string_view field, std::string_view what, double lowest,
                                         double highest) const {
  const double number = read_number(field, position_, [&] { return std::string(what); });
  return require_between(number, what, lowest, highest, position_);
}

GONIO_INLINE sample_collector rt300s_reader::read() {
  while (next()) read_line();
  if (!has_type_) gonio::refuse({position_.name, ": is empty, expected a line DataType: ", rt300s_type});
  return std::move(collector_);
}

GONIO_INLINE void rt300s_reader::read_line() {
  const std::string_view key = fields_.front(), value = fields_.size() > 1 ? fields_[1] : "";
  if (key == "DataType:") {
    if (value != rt300s_type) position_.refuse({"DataType: ", in_quotes(value), ", expected ", rt300s_type});
    has_type_ = true;
    is_in_table_ = false;
    incidence_.reset();
  } else if (!has_type_) {
    position_.refuse({in_quotes(key), ", expected DataType: ", rt300s_type});
  } else if (key == "Incidence:") {
    incidence_ = angle(value, "Incidence (degrees)", 0.0, 90.0);
  } else if (key == "Raw data") {
    if (!incidence_) position_.refuse("there is no line Incidence above the table");
    is_in_table_ = true;
    receivers_.clear();
  } else if (is_in_table_ && receivers_.empty()) {
    read_receivers();
  } else if (is_in_table_) {
    read_row();
  } else if (!key.ends_with(':')) {
    position_.refuse({in_quotes(key), ", expected a name with a colon, or 'Raw data'"});
  }
}

GONIO_INLINE void rt300s_reader::read_receivers() {
  if (!fields_.front().empty() || fields_.size() < 2)
    position_.refuse({in_quotes(fields_.front()), ", expected an empty field and the receiver's angles"});
  for (std::size_t i = 1; i < fields_.size(); ++i)
    receivers_.push_back(angle(fields_[i], "the receiver's angle (degrees)", -90.0, 90.0));
}

GONIO_INLINE void rt300s_reader::read_row() {
  if (fields_.size() != receivers_.size() + 1)
    position_.refuse({fields_.size(), fields_.size() == 1 ? " field" : " fields", ", expected an azimuth and ",
                      receivers_.size(), receivers_.size() == 1 ? " value" : " values"});
  rt300s_pose pose{.azimuth = angle(fields_.front(), "the azimuth (degrees)", -360.0, 360.0), .incidence = *incidence_};
  for (std::size_t i = 0; i < receivers_.size(); ++i) {
    pose.receiver = receivers_[i];
    const double value = read_number(fields_[i + 1], position_, [] { return "a value"; });
    add_reading(collector_, pose, value, 0.01, position_);
  }
}

// ---- the sheet -----------------------------------------------------------------------------------------------------

/// Returns a row: a number for each reading, or nothing if it has no value.
[[nodiscard]] GONIO_INLINE std::vector<std::optional<double>> sheet_row(csv_reader& sheet, std::string_view name) {
  std::vector<std::optional<double>> numbers;
  for (std::size_t i = 1; i < sheet.fields().size(); ++i) {
    const std::string_view field = sheet.fields()[i];
    double number = 0.0;
    if (field.empty()) {
      numbers.emplace_back();
      continue;
    }
    if (const char* wrong = sheet.read_number(field, number))
      sheet.position().refuse({name, ": ", in_quotes(field), wrong});
    numbers.emplace_back(number);
  }
  return numbers;
}

/// Reads the rows of angles, which are above the row RT, and the row RT; ignores rows below it.
[[nodiscard]] GONIO_INLINE sample_collector collect_rt300s_sheet(std::string_view text, const std::string& name) {
  csv_reader sheet(text, name);
  std::vector<std::optional<double>> azimuths, incidences, receivers, readings;
  while (readings.empty() && sheet.next()) {
    const std::string_view key = sheet.fields().front();
    if (key == "Azimuth") azimuths = sheet_row(sheet, key);
    if (key == "Incidence") incidences = sheet_row(sheet, key);
    if (key == "Receive") receivers = sheet_row(sheet, key);
    if (key == "RT") readings = sheet_row(sheet, key);
  }
  if (readings.empty()) gonio::refuse({name, ": has no row RT"});
  const text_position& position = sheet.position();
  if (azimuths.empty() || incidences.empty() || receivers.empty())
    position.refuse("expected the rows Azimuth, Incidence and Receive above the row RT");
  sample_collector collector;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (!readings[i]) continue;
    if (!azimuths[i] || !incidences[i] || !receivers[i])
      position.refuse({"reading ", i + 1, " has RT, but not all three angles"});
    const rt300s_pose pose{require_between(*azimuths[i], "Azimuth (degrees)", -360.0, 360.0, position),
                           require_between(*incidences[i], "Incidence (degrees)", 0.0, 90.0, position),
                           require_between(*receivers[i], "Receive (degrees)", -90.0, 90.0, position)};
    add_reading(collector, pose, *readings[i], 1.0, position);
  }
  return collector;
}

[[nodiscard]] GONIO_INLINE bool is_rt300s_sheet(std::string_view text) {
  text_position position;
  std::string_view line;
  text = without_byte_order_mark(text);
  if (!next_whole_line(text, position, line)) return false;
  std::vector<std::string_view> fields;
  if (dialect_of(line).split(line, fields) != nullptr || fields.size() < 2) return false;
  return fields[0] == "Method" && fields[1].starts_with("BRDF");
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE bool looks_like_rt300s(std::string_view text) {
  text_position position;
  std::string_view rest = without_byte_order_mark(text), line;
  if (!next_whole_line(rest, position, line)) return false;
  const bool is_text = line.starts_with("DataType:") && line.find(detail::rt300s_type) != std::string_view::npos;
  return is_text || detail::is_rt300s_sheet(text);
}

GONIO_INLINE sample_set read_rt300s(std::string_view text, const std::string& name) {
  if (detail::is_rt300s_sheet(text)) return detail::collect_rt300s_sheet(text, name).samples(name);
  text_position position{name, 0};
  return detail::rt300s_reader(text, position).read().samples(name);
}

GONIO_INLINE sample_set read_rt300s(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_rt300s(as_text(bytes), path.string());
}

}  // namespace gonio::io
