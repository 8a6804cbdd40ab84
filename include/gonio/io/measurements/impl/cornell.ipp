#pragma once
/// Bodies of io/measurements/cornell.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/measurements/cornell.hpp>
#include <gonio/io/text/text.hpp>
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

GONIO_INLINE void cornell_reader::read(std::string_view line) {
  split_at_blanks(line, fields_);
  if (count_ == 0)
    read_count();
  else if (!collector_)
    read_wavelengths();
  else
    read_sample();
}

GONIO_INLINE sample_collector cornell_reader::samples() && {
  if (!collector_)
    gonio::refuse({position_.name, ": expected ", count_, " wavelengths, the file ends after ", wavelengths_.size()});
  return *std::move(collector_);
}

GONIO_INLINE void cornell_reader::read_count() {
  const double given = number(0);
  if (fields_.size() != 1 || !(given >= 2.0 && given <= 1e4 && given == std::floor(given)))
    position_.refuse("expected the number of wavelengths, at least 2, not " + in_quotes(fields_[0]));
  count_ = static_cast<std::size_t>(given);
}

GONIO_INLINE void cornell_reader::read_wavelengths() {
  if (wavelengths_.size() + fields_.size() > count_)
    position_.refuse("more than the " + std::to_string(count_) + " wavelengths that the file declares");
  for (std::size_t i = 0; i < fields_.size(); ++i) wavelengths_.push_back(number(i));
  if (wavelengths_.size() < count_) return;
  try {
    collector_.emplace(channels(wavelengths_));
  } catch (const error& reason) {
    position_.refuse(reason.what());
  }
}

GONIO_INLINE void cornell_reader::read_sample() {
  if (fields_.size() != 4 + count_)
    position_.refuse(std::to_string(fields_.size()) + " fields, expected 4 angles and " + std::to_string(count_) +
                     " reflectances");
  reflectances_.clear();
  for (std::size_t i = 4; i < fields_.size(); ++i) {
    reflectances_.push_back(number(i));
    if (std::abs(reflectances_.back()) > double{std::numeric_limits<float>::max()})
      position_.refuse("field " + std::to_string(i + 1) + ": " + shortest(reflectances_.back()) +
                       " sr^-1 is outside the range of float");
  }
  const direction wi = read_direction(0), wo = read_direction(2);
  collector_->add({wi, wo}, reflectances_);
}

GONIO_INLINE direction cornell_reader::read_direction(std::size_t field) const {
  const double theta = number(field), phi = number(field + 1);
  if (!(theta >= 0.0 && theta < std::numbers::pi / 2.0))
    position_.refuse("field " + std::to_string(field + 1) + ": polar angle " + shortest(theta) +
                     ", expected at least 0 and less than pi / 2");
  if (!(std::abs(phi) <= 6.3))
    position_.refuse("field " + std::to_string(field + 2) + ": azimuth " + shortest(phi) +
                     ", expected from -2 pi to 2 pi");
  return spherical_direction(theta, phi);
}

[[nodiscard]] GONIO_INLINE sample_collector collect_cornell(std::string_view text, const std::string& name) {
  text_position position{name, 0};
  cornell_reader reader(position);
  for_each_line(text, position, [&](std::string_view line) { reader.read(line); });
  return std::move(reader).samples();
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE sample_set read_cornell(std::string_view text, const std::string& name) {
  return detail::collect_cornell(text, name).samples(name);
}

GONIO_INLINE sample_set read_cornell(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_cornell(as_text(bytes), path.string());
}

}  // namespace gonio::io
