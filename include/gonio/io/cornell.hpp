#pragma once
/// Measurements in the text format of Cornell's reflectance database (Foo, A Gonioreflectometer for Measuring the
/// Bidirectional Reflectance of Material for Use in Illumination Computation, 1997): the number of wavelengths, then
/// these in nanometres, then a line for each pair of directions: theta_i, phi_i, theta_s, phi_s in radians, and a
/// reflectance in sr^-1 for each wavelength. Lines that start with # are comments.

#include <gonio/core/spectrum.hpp>
#include <gonio/io/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

namespace detail {

/// Reads such a file line by line.
class cornell_parser {
 public:
  explicit cornell_parser(text_place& place) : place_(place) {}

  void read(std::string_view line) {
    split(line);
    if (count_ == 0)
      read_count();
    else if (!colour_)
      read_wavelengths();
    else
      read_sample();
  }

  /// What was read. Throws gonio::error if that is not a whole measurement.
  [[nodiscard]] sample_set samples() && {
    if (!colour_)
      throw error(place_.name + ": ends before its " + std::to_string(count_) + " wavelengths, of which there are " +
                  std::to_string(wavelengths_.size()));
    if (samples_.empty()) throw error(place_.name + ": has no samples, expected at least one");
    return std::move(samples_);
  }

 private:
  void split(std::string_view line) {
    fields_.clear();
    while (!line.empty()) {
      const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
      fields_.push_back(line.substr(0, end));
      line = trimmed(line.substr(end));
    }
  }

  [[nodiscard]] double number(std::size_t field) const {
    return parse_number(fields_[field], place_, [&] { return "field " + std::to_string(field + 1); });
  }

  void read_count() {
    const double given = number(0);
    if (fields_.size() != 1 || !(given >= 2.0 && given <= 1e4 && given == std::floor(given)))
      place_.refuse("expected the number of wavelengths, at least 2, not " + quoted(fields_[0]));
    count_ = static_cast<std::size_t>(given);
  }

  void read_wavelengths() {
    if (wavelengths_.size() + fields_.size() > count_)
      place_.refuse("more than the " + std::to_string(count_) + " wavelengths that the file announces");
    for (std::size_t i = 0; i < fields_.size(); ++i) wavelengths_.push_back(number(i));
    if (wavelengths_.size() < count_) return;
    try {
      colour_.emplace(wavelengths_);
    } catch (const error& reason) {
      place_.refuse(reason.what());
    }
  }

  void read_sample() {
    if (fields_.size() != 4 + count_)
      place_.refuse(std::to_string(fields_.size()) + " fields, expected 4 angles and " + std::to_string(count_) +
                    " reflectances");
    reflectances_.clear();
    for (std::size_t i = 4; i < fields_.size(); ++i) reflectances_.push_back(number(i));
    const direction wi = read_direction(0), wo = read_direction(2);
    samples_.push_back({to_half_difference(wi, wo), (*colour_)(reflectances_), 1.0});
  }

  /// From a polar angle and the azimuth after it.
  [[nodiscard]] direction read_direction(std::size_t field) const {
    const double theta = number(field), phi = number(field + 1);
    if (!(theta >= 0.0 && theta < std::numbers::pi / 2.0))
      place_.refuse("field " + std::to_string(field + 1) + ": polar angle " + shortest(theta) +
                    ", expected at least 0 and less than pi / 2");
    if (!(std::abs(phi) <= 6.3))
      place_.refuse("field " + std::to_string(field + 2) + ": azimuth " + shortest(phi) +
                    ", expected from -2 pi to 2 pi");
    return spherical_direction(theta, phi);
  }

  text_place& place_;
  std::size_t count_ = 0;
  std::vector<double> wavelengths_, reflectances_;
  std::optional<spectral_colour> colour_;
  std::vector<std::string_view> fields_;
  sample_set samples_;
};

}  // namespace detail

/// Samples from the text of such a file, as linear Rec. 709 under D65; `name` is what errors call it. Throws
/// gonio::error naming line and field of what is wrong.
[[nodiscard]] inline sample_set parse_cornell(std::string_view text, const std::string& name) {
  detail::text_place place{name, 0};
  detail::cornell_parser parser(place);
  detail::for_each_line(text, place, [&](std::string_view line) { parser.read(line); });
  return std::move(parser).samples();
}

/// Reads such a file. Throws gonio::error naming file, line and field of what is wrong.
[[nodiscard]] inline sample_set read_cornell(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return parse_cornell(detail::as_text(bytes), path.string());
}

}  // namespace gonio::io
