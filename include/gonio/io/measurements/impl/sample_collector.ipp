#pragma once
/// Bodies of io/measurements/sample_collector.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>
#include <gonio/table/spectral_samples.hpp>

#include <Eigen/Core>

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
  require_wavelengths(wavelengths);
  colour_channels channels(wavelengths.size() == 1 ? kind::grey : kind::spectrum, wavelengths.size());
  channels.wavelengths_.assign(wavelengths.begin(), wavelengths.end());
  const auto is_visible = [](double wavelength) { return wavelength >= 380.0 && wavelength <= 780.0; };
  if (std::ranges::count_if(wavelengths, is_visible) >= 2) channels.colour_.emplace(wavelengths);
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

GONIO_INLINE void sample_collector::use_wavelengths(std::span<const double> wavelengths) {
  if (std::ranges::equal(wavelengths, channels_.wavelengths())) return;
  share_wavelengths_ = share_wavelengths_ && samples_.empty();
  channels_ = colour_channels::spectrum(wavelengths);
}

GONIO_INLINE void sample_collector::add(const direction_pair& pair, std::span<const double> values, double weight) {
  if (!is_above_horizon(pair.wi) || !is_above_horizon(pair.wo)) return;
  have_colours_ = have_colours_ && channels_.have_colour();
  samples_.push_back({pair, have_colours_ ? channels_(values) : rgb(rgb::Zero()), weight});
  if (share_wavelengths_ && !channels_.wavelengths().empty())
    for (const double value : values) spectra_.push_back(static_cast<float>(value));
}

GONIO_INLINE void sample_collector::require_samples(const std::string& name) const {
  if (samples_.empty()) gonio::refuse({name, ": has no sample above the horizon, expected at least one"});
}

GONIO_INLINE sample_set sample_collector::samples(const std::string& name) && {
  require_samples(name);
  if (!have_colours_)
    gonio::refuse(
        {name, ": its spectra make no colours: fewer than two wavelengths are visible (380 to 780 nanometres)"});
  return std::move(samples_);
}

GONIO_INLINE spectral_samples sample_collector::spectra(const std::string& name) && {
  require_samples(name);
  const std::vector<double>& wavelengths = channels_.wavelengths();
  if (wavelengths.empty()) gonio::refuse({name, ": has no spectra: its values are of no stated wavelength"});
  if (!share_wavelengths_)
    gonio::refuse(
        {name, ": has other wavelengths in one pair of directions than in another, expected the same in all"});
  const auto rows = std::ssize(samples_), bands = std::ssize(wavelengths);
  spectral_samples found{wavelengths, {}, Eigen::Map<const cell_matrix>(spectra_.data(), rows, bands)};
  const bool are_weighted = std::ranges::any_of(samples_, [](const sample& each) { return each.weight[0] != 1.0; });
  for (const sample& each : samples_) {
    found.directions.push_back(each.directions);
    if (are_weighted) found.weights.push_back(each.weight[0]);
  }
  return found;
}

}  // namespace gonio::io::detail
