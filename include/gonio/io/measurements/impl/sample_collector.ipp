#pragma once
/// Bodies of io/measurements/sample_collector.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/aperture.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE void require_float_range(double reflectance, const text_position& position) {
  if (std::abs(reflectance) > double{std::numeric_limits<float>::max()})
    position.refuse({shortest(reflectance), " sr^-1 is outside the range of float"});
}

GONIO_INLINE double require_between(double number, std::string_view name, double lowest, double highest,
                                    const text_position& position) {
  if (!(number >= lowest && number <= highest))
    position.refuse({name, ": ", shortest(number), ", expected from ", shortest(lowest), " to ", shortest(highest)});
  return number;
}

GONIO_INLINE double receiver_half_angle(double solid_angle, const json_reader& read) {
  try {
    return half_angle_of(solid_angle);
  } catch (const error& reason) {
    read.refuse({"the receiver has ", reason.what()});
  }
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

GONIO_INLINE sample_collector sample_collector::of_xyz() {
  sample_collector collector{channels()};
  collector.are_xyz_ = true;
  return collector;
}

GONIO_INLINE void sample_collector::use_wavelengths(std::span<const double> wavelengths) {
  if (std::ranges::equal(wavelengths, kinds_.wavelengths())) return;
  if (!samples_.empty() && !are_mixed_) {
    are_mixed_ = true;
    have_colours_ = kinds_.have_colour();
    if (have_colours_) samples_ = samples_.colours();
  }
  kinds_ = channels({wavelengths.begin(), wavelengths.end()});
  if (samples_.empty()) samples_ = sample_set(kinds_);
}

GONIO_INLINE void sample_collector::add(const direction_pair& pair, std::span<const double> values, double weight) {
  if (!is_above_horizon(pair.wi) || !is_above_horizon(pair.wo)) return;
  if (are_mixed_) have_colours_ = have_colours_ && kinds_.have_colour();
  if (are_mixed_ && !have_colours_) return;
  if (are_xyz_)
    samples_.push_back({pair, from_xyz({values[0], values[1], values[2]}), weight});
  else if (are_mixed_)
    samples_.push_back({pair, kinds_.colour(values), weight});
  else
    samples_.add(pair, values, weight);
}

GONIO_INLINE sample_set sample_collector::samples(const std::string& name) && {
  if (samples_.empty()) gonio::refuse({name, ": has no sample above the horizon, expected at least one"});
  if (!have_colours_)
    gonio::refuse({name,
                   ": pairs of directions have different wavelengths, and those of some pairs make no colour, "
                   "expected the same wavelengths in all pairs"});
  return aperture_.is_point() ? std::move(samples_) : samples_.through(aperture_);
}

}  // namespace gonio::io::detail
