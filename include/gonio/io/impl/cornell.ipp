#pragma once
/// Bodies of io/cornell.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/io/cornell.hpp>
#include <gonio/io/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE void cornell_parser::read(std::string_view line) {
  split(line);
  if (count_ == 0)
    read_count();
  else if (!colour_)
    read_wavelengths();
  else
    read_sample();
}

GONIO_INLINE void cornell_parser::require_whole() const {
  if (!colour_)
    gonio::refuse(
        {place_.name, ": ends before its ", count_, " wavelengths, of which there are ", wavelengths_.size()});
  if (samples_.empty()) gonio::refuse({place_.name, ": has no samples, expected at least one"});
}

GONIO_INLINE sample_set cornell_parser::samples() && {
  require_whole();
  return std::move(samples_);
}

GONIO_INLINE spectral_samples cornell_parser::spectra() && {
  require_whole();
  const auto rows = std::ssize(samples_), bands = std::ssize(wavelengths_);
  spectral_samples found{wavelengths_, {}, Eigen::Map<const cell_matrix>(spectra_.data(), rows, bands)};
  for (const sample& each : samples_) found.directions.push_back(each.directions);
  return found;
}

GONIO_INLINE void cornell_parser::split(std::string_view line) {
  fields_.clear();
  while (!line.empty()) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    fields_.push_back(line.substr(0, end));
    line = trimmed(line.substr(end));
  }
}

GONIO_INLINE void cornell_parser::read_count() {
  const double given = number(0);
  if (fields_.size() != 1 || !(given >= 2.0 && given <= 1e4 && given == std::floor(given)))
    place_.refuse("expected the number of wavelengths, at least 2, not " + quoted(fields_[0]));
  count_ = static_cast<std::size_t>(given);
}

GONIO_INLINE void cornell_parser::read_wavelengths() {
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

GONIO_INLINE void cornell_parser::read_sample() {
  if (fields_.size() != 4 + count_)
    place_.refuse(std::to_string(fields_.size()) + " fields, expected 4 angles and " + std::to_string(count_) +
                  " reflectances");
  reflectances_.clear();
  for (std::size_t i = 4; i < fields_.size(); ++i) {
    reflectances_.push_back(number(i));
    if (std::abs(reflectances_.back()) > double{std::numeric_limits<float>::max()})
      place_.refuse("field " + std::to_string(i + 1) + ": " + shortest(reflectances_.back()) +
                    " sr^-1 is beyond the range of float");
  }
  const direction wi = read_direction(0), wo = read_direction(2);
  samples_.push_back({direction_pair{wi, wo}, (*colour_)(reflectances_), 1.0});
  for (const double reflectance : reflectances_) spectra_.push_back(static_cast<float>(reflectance));
}

GONIO_INLINE direction cornell_parser::read_direction(std::size_t field) const {
  const double theta = number(field), phi = number(field + 1);
  if (!(theta >= 0.0 && theta < std::numbers::pi / 2.0))
    place_.refuse("field " + std::to_string(field + 1) + ": polar angle " + shortest(theta) +
                  ", expected at least 0 and less than pi / 2");
  if (!(std::abs(phi) <= 6.3))
    place_.refuse("field " + std::to_string(field + 2) + ": azimuth " + shortest(phi) +
                  ", expected from -2 pi to 2 pi");
  return spherical_direction(theta, phi);
}

/// What `take` makes of the parser once it has read the text.
template <class Take>
[[nodiscard]] auto parsed_cornell(std::string_view text, const std::string& name, const Take& take) {
  text_place place{name, 0};
  cornell_parser parser(place);
  for_each_line(text, place, [&](std::string_view line) { parser.read(line); });
  return take(std::move(parser));
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE sample_set parse_cornell(std::string_view text, const std::string& name) {
  return detail::parsed_cornell(text, name, [](auto&& parser) { return std::move(parser).samples(); });
}

GONIO_INLINE spectral_samples parse_cornell_spectra(std::string_view text, const std::string& name) {
  return detail::parsed_cornell(text, name, [](auto&& parser) { return std::move(parser).spectra(); });
}

GONIO_INLINE spectral_samples read_cornell_spectra(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return parse_cornell_spectra(detail::as_text(bytes), path.string());
}

GONIO_INLINE sample_set read_cornell(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return parse_cornell(detail::as_text(bytes), path.string());
}

}  // namespace gonio::io
