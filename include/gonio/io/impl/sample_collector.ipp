#pragma once
/// Bodies of io/sample_collector.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/io/sample_collector.hpp>
#include <gonio/io/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE colour_channels colour_channels::spectrum(std::span<const double> wavelengths) {
  if (wavelengths.size() == 1) return grey();
  const auto is_visible = [](double wavelength) { return wavelength >= 380.0 && wavelength <= 780.0; };
  if (std::ranges::count_if(wavelengths, is_visible) < 2)
    gonio::refuse("fewer than two of the wavelengths are visible (380 to 780 nanometres)");
  colour_channels channels(kind::spectrum, wavelengths.size());
  channels.colour_.emplace(wavelengths);
  return channels;
}

GONIO_INLINE rgb colour_channels::operator()(std::span<const double> values) const {
  if (kind_ == kind::grey) return rgb::Constant(values[0]);
  if (kind_ == kind::spectrum) return (*colour_)(values);
  const rgb given{values[0], values[1], values[2]};
  return kind_ == kind::xyz ? from_xyz(given) : given;
}

GONIO_INLINE void require_float_range(double reflectance, const text_place& place) {
  if (std::abs(reflectance) > double{std::numeric_limits<float>::max()})
    place.refuse({shortest(reflectance), " sr^-1 is beyond the range of float"});
}

GONIO_INLINE std::vector<bool> are_new_azimuths(std::span<const double> azimuths) {
  constexpr double millionths = 1e6, turn = 360.0;
  std::set<long long> known;
  std::vector<bool> are_new;
  for (const double azimuth : azimuths) {
    const double within_turn = azimuth - turn * std::floor(azimuth / turn);
    const long long rounded = std::llround(millionths * within_turn);
    are_new.push_back(known.insert(rounded == std::llround(millionths * turn) ? 0 : rounded).second);
  }
  return are_new;
}

GONIO_INLINE void sample_collector::add(const direction_pair& pair, const rgb& value, double weight) {
  if (is_above_horizon(pair.wi) && is_above_horizon(pair.wo)) samples_.push_back({pair, value, weight});
}

GONIO_INLINE sample_set sample_collector::take(const std::string& name) && {
  if (samples_.empty()) gonio::refuse({name, ": has no sample above the horizon, expected at least one"});
  return std::move(samples_);
}

}  // namespace gonio::io::detail
