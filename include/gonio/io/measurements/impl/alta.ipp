#pragma once
/// Bodies of io/measurements/alta.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/alta.hpp>
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
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// How the numbers of a line give the directions.
enum class alta_input {
  half_difference,
  half_difference_with_azimuth,
  spherical,
  azimuth_difference,
  projected,
  vectors
};

struct alta_parametrisation {
  std::string_view name;
  alta_input input;
  std::size_t numbers;
};

inline constexpr std::array<alta_parametrisation, 6> alta_inputs{
    {{"RUSIN_TH_TD_PD", alta_input::half_difference, 3},
     {"RUSIN_TH_PH_TD_PD", alta_input::half_difference_with_azimuth, 4},
     {"SPHERICAL_TL_PL_TV_PV", alta_input::spherical, 4},
     {"ISOTROPIC_TV_TL_DPHI", alta_input::azimuth_difference, 3},
     {"ISOTROPIC_TL_TV_PROJ_DPHI", alta_input::projected, 3},
     {"CARTESIAN", alta_input::vectors, 6}}};

/// Reads a file line by line.
class alta_reader {
 public:
  explicit alta_reader(text_position& position) : position_(position) {}

  void read(std::string_view line);

  /// Returns the samples read. Throws gonio::error if the measurement is incomplete.
  [[nodiscard]] sample_collector samples() &&;

 private:
  void read_entry(std::string_view line);
  void read_input(std::string_view name);
  void read_output(std::string_view name);
  void read_dimensions(std::string_view value);
  void begin_rows();
  void read_row(std::string_view line);
  [[nodiscard]] double polar_angle(double angle) const;
  [[nodiscard]] double azimuth(double angle) const;
  [[nodiscard]] direction unit_vector(std::span<const double> numbers) const;
  [[nodiscard]] direction_pair directions() const;

  text_position& position_;
  const alta_parametrisation* input_ = nullptr;
  std::size_t inputs_ = 0, outputs_ = 0;  ///< from #DIM
  std::string output_;
  std::optional<sample_collector> collector_;
  std::vector<std::string_view> words_;
  std::vector<double> numbers_, values_;
};

GONIO_INLINE void alta_reader::read(std::string_view line) {
  if (line.front() != '#') return read_row(line);
  if (!collector_) read_entry(line.substr(1));
}

GONIO_INLINE sample_collector alta_reader::samples() && {
  if (!collector_) gonio::refuse({position_.name, ": has no line of numbers below its header"});
  return *std::move(collector_);
}

GONIO_INLINE void alta_reader::read_entry(std::string_view line) {
  const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
  const std::string_view key = line.substr(0, end), value = trimmed(line.substr(end));
  if (key == "DIM") read_dimensions(value);
  if (key == "PARAM_IN") read_input(value);
  if (key == "PARAM_OUT") read_output(value);
  if (key == "FORMAT" && value != "text")
    position_.refuse({"#FORMAT ", in_quotes(value), " is not supported, expected text"});
}

GONIO_INLINE void alta_reader::read_dimensions(std::string_view value) {
  constexpr double most = 16.0;
  std::vector<std::string_view> words;
  split_at_blanks(value, words);
  if (words.size() != 2) position_.refuse({"#DIM: ", in_quotes(value), ", expected two counts from 1 to 16"});
  const auto count = [&](std::string_view word) {
    const double number = read_number(word, position_, [] { return "#DIM"; });
    if (!(number >= 1.0 && number <= most && number == std::floor(number)))
      position_.refuse({"#DIM: ", in_quotes(word), ", expected two counts from 1 to 16"});
    return static_cast<std::size_t>(number);
  };
  inputs_ = count(words[0]);
  outputs_ = count(words[1]);
}

GONIO_INLINE void alta_reader::read_input(std::string_view name) {
  const auto* const found = std::ranges::find(alta_inputs, name, &alta_parametrisation::name);
  if (found == alta_inputs.end()) {
    std::vector<std::string_view> names;
    for (const alta_parametrisation& each : alta_inputs) names.push_back(each.name);
    position_.refuse({"#PARAM_IN ", in_quotes(name), " is unknown or does not give both directions, expected ",
                      listed(names, " or ")});
  }
  input_ = found;
}

GONIO_INLINE void alta_reader::read_output(std::string_view name) {
  constexpr std::array<std::string_view, 4> known{"INV_STERADIAN", "INV_STERADIAN_COSINE_FACTOR", "RGB_COLOR",
                                                  "XYZ_COLOR"};
  if (std::ranges::find(known, name) == known.end())
    position_.refuse({"#PARAM_OUT ", in_quotes(name), " does not name the quantity of the values, expected ",
                      listed(known, " or ")});
  output_ = name;
}

/// Checks the complete header and prepares the collector.
GONIO_INLINE void alta_reader::begin_rows() {
  if (input_ == nullptr) position_.refuse("there is no line #PARAM_IN above the numbers");
  if (output_.empty())
    position_.refuse(
        "there is no line #PARAM_OUT above the numbers, expected one such as "
        "'#PARAM_OUT INV_STERADIAN' (a BRDF, sr^-1)");
  const bool is_colour = output_.ends_with("COLOR");
  if (inputs_ != input_->numbers || outputs_ != (is_colour ? 3U : 1U))
    position_.refuse({"#DIM states ", inputs_, " and ", outputs_, " numbers, expected ", input_->numbers,
                      " for #PARAM_IN ", input_->name, " and ", is_colour ? 3 : 1, " for #PARAM_OUT ", output_});
  if (output_ == "RGB_COLOR")
    collector_.emplace(channels());
  else
    collector_.emplace(output_ == "XYZ_COLOR" ? sample_collector::of_xyz() : sample_collector());
}

GONIO_INLINE double alta_reader::polar_angle(double angle) const {
  // A rounded pi / 2 may be slightly larger than pi / 2.
  if (!(std::abs(angle) < std::numbers::pi / 2.0 + 1e-3))
    position_.refuse({"a polar angle is ", shortest(angle), ", expected radians from -pi / 2 to pi / 2",
                      std::abs(angle) <= 90.0 ? "; are these degrees?" : ""});
  return angle;
}

GONIO_INLINE double alta_reader::azimuth(double angle) const {
  if (!(std::abs(angle) < 6.3))
    position_.refuse({"an azimuth is ", shortest(angle), ", expected radians from -2 pi to 2 pi"});
  return angle;
}

GONIO_INLINE direction alta_reader::unit_vector(std::span<const double> numbers) const {
  const direction w(numbers[0], numbers[1], numbers[2]);
  const double length = norm_of(w.x(), w.y(), w.z());
  if (!(std::abs(length - 1.0) <= 1e-3)) position_.refuse({"a vector has length ", shortest(length), ", expected 1"});
  return w / length;
}

/// Returns light and viewer. ALTA's difference angles are the viewer's; MERL's and gonio's are the light's.
GONIO_INLINE direction_pair alta_reader::directions() const {
  const std::vector<double>& x = numbers_;
  const auto of_half = [&](double theta_h, double theta_d, double phi_d) {
    const direction_pair pair = to_directions({polar_angle(theta_h), polar_angle(theta_d), azimuth(phi_d)});
    return direction_pair{pair.wo, pair.wi};
  };
  switch (input_->input) {
    case alta_input::half_difference:
      return of_half(x[0], x[1], x[2]);
    case alta_input::half_difference_with_azimuth: {
      const direction_pair pair = of_half(x[0], x[2], x[3]);
      const double phi_h = azimuth(x[1]);
      return {turned_about_normal(pair.wi, phi_h), turned_about_normal(pair.wo, phi_h)};
    }
    case alta_input::spherical:
      return {spherical_direction(polar_angle(x[0]), azimuth(x[1])),
              spherical_direction(polar_angle(x[2]), azimuth(x[3]))};
    case alta_input::azimuth_difference:
      return {spherical_direction(polar_angle(x[1]), azimuth(x[2])), spherical_direction(polar_angle(x[0]), 0.0)};
    case alta_input::projected:
      return {spherical_direction(polar_angle(x[0]), 0.0),
              spherical_direction(polar_angle(std::hypot(x[1], x[2])), std::atan2(x[2], x[1]))};
    case alta_input::vectors:
      break;
  }
  return {unit_vector(std::span(x).subspan(3, 3)), unit_vector(std::span(x).first(3))};
}

GONIO_INLINE void alta_reader::read_row(std::string_view line) {
  if (!collector_) begin_rows();
  numbers_.clear();
  split_at_blanks(line, words_);
  for (const std::string_view word : words_)
    numbers_.push_back(read_number(word, position_, [&] { return message_of({"number ", numbers_.size() + 1}); }));
  const std::size_t needed = inputs_ + outputs_, most = needed + 2 * outputs_;  // with confidence intervals
  if (numbers_.size() < needed || numbers_.size() > most)
    position_.refuse({numbers_.size(), " numbers, expected ", needed, " as in #DIM"});
  const direction_pair pair = directions();
  if (!is_above_horizon(pair.wi) || !is_above_horizon(pair.wo)) return;
  const double factor = output_ == "INV_STERADIAN_COSINE_FACTOR" ? 1.0 / pair.wo.z() : 1.0;
  values_.clear();
  for (std::size_t i = inputs_; i < needed; ++i) {
    values_.push_back(factor * numbers_[i]);
    require_float_range(values_.back(), position_);
  }
  collector_->add(pair, values_);
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE bool looks_like_alta(std::string_view text) {
  text = without_byte_order_mark(text);
  text_position position;
  bool has_dimensions = false, has_input = false;
  for (std::string_view line; next_whole_line(text, position, line);) {
    line = trimmed(line);
    has_dimensions |= line.starts_with("#DIM ") || line.starts_with("#DIM\t");
    has_input |= line.starts_with("#PARAM_IN ") || line.starts_with("#PARAM_IN\t");
    if (has_dimensions && has_input) return true;
    if (line.front() != '#') return false;
  }
  return false;
}

GONIO_INLINE sample_set read_alta(std::string_view text, const std::string& name) {
  text_position position{name, 0};
  detail::alta_reader reader(position);
  text = without_byte_order_mark(text);
  for (std::string_view line; next_whole_line(text, position, line);) reader.read(trimmed(line));
  return std::move(reader).samples().samples(name);
}

GONIO_INLINE sample_set read_alta(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_alta(as_text(bytes), path.string());
}

}  // namespace gonio::io
