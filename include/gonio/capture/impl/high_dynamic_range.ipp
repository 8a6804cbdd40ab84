#pragma once
/// Bodies of capture/high_dynamic_range.hpp.

#include <gonio/capture/camera_response.hpp>
#include <gonio/capture/device.hpp>
#include <gonio/capture/high_dynamic_range.hpp>
#include <gonio/core/compiled.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::capture {

GONIO_INLINE void sensor_noise::require_usable() const {
  for (const double number : {read, shot, relative})
    if (!(number >= 0.0 && std::isfinite(number)))
      refuse("a sensor's noise must be finite and not negative, not " + std::to_string(number));
}

GONIO_INLINE double sensor_noise::relative_variance(const camera_response& response, double count,
                                                    double pixels) const noexcept {
  constexpr double rounding = 1.0 / 12.0;
  const double slope = response.slope(count);
  return slope * slope * (read * read + shot * count + rounding) / pixels + relative * relative;
}

}  // namespace gonio::capture

namespace gonio::capture::detail {

GONIO_INLINE measured_radiance mean_radiance(std::vector<exposed> all, const camera_response& response,
                                             const sensor_noise& noise, double saturation, double pixels) {
  const auto is_guess = [&](const exposed& each) { return each.count < response.smallest_known_count(); };
  if (!std::ranges::all_of(all, is_guess)) std::erase_if(all, is_guess);
  const auto mean = [&](const auto& expected_count) {
    double weights = 0.0, sum = 0.0;
    for (const exposed& each : all) {
      const double expected = expected_count(each);
      if (expected >= saturation) continue;  // expected to be saturated: noise made this count darker
      const double predicted = response.exposure(expected) / each.time;
      const double weight = 1.0 / (predicted * predicted * noise.relative_variance(response, expected, pixels));
      weights += weight;
      sum += weight * each.exposure / each.time;
    }
    return std::pair(weights > 0.0 ? sum / weights : 0.0, weights);
  };
  auto [value, weights] = mean([](const exposed& each) { return each.count; });
  if (!(weights > 0.0)) return {};
  for (int pass = 0; pass < 2; ++pass) {
    const auto [better, certainty] =
        mean([&, at = value](const exposed& each) { return std::max(response.count(at * each.time), 0.5); });
    if (!(certainty > 0.0)) break;
    value = better;
    weights = certainty;
  }
  return {value, 1.0 / std::sqrt(weights), false, false};
}

GONIO_INLINE void require_times(Eigen::Index images, std::span<const double> times, const std::string& what) {
  if (images != std::ssize(times) || times.empty())
    refuse(what + " has " + std::to_string(times.size()) + " exposure times, expected as many, and at least one");
  for (const double time : times)
    if (!(time > 0.0 && std::isfinite(time))) refuse("an exposure time must be positive, not " + std::to_string(time));
}

GONIO_INLINE measured_radiance saturated_radiance(const camera_response& response, std::span<const double> times,
                                                  std::uint16_t saturation) {
  return {response.exposure(saturation) / std::ranges::min(times), std::numeric_limits<double>::infinity(), true,
          false};
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE measured_radiance merge_exposures(std::span<const std::uint16_t> counts, std::span<const double> times,
                                               const camera_response& response, const sensor_noise& noise,
                                               std::uint16_t saturation) {
  detail::require_times(counts.size(), times, "a pixel of " + std::to_string(counts.size()) + " counts");
  noise.require_usable();
  const std::uint16_t limit = saturation > 0 ? saturation : response.largest_count();
  std::vector<detail::exposed> usable;
  for (Eigen::Index j = 0; j < std::ssize(counts); ++j)
    if (counts[j] > 0 && counts[j] < limit)
      usable.push_back({times[j], response.exposure(counts[j]), static_cast<double>(counts[j])});
  const measured_radiance merged = detail::mean_radiance(std::move(usable), response, noise, limit, 1.0);
  if (merged.value > 0.0) return merged;
  if (std::ranges::all_of(counts, [](std::uint16_t count) { return count == 0; }))
    return detail::dark_radiance(response, times);
  return detail::saturated_radiance(response, times, limit);
}

GONIO_INLINE measured_radiance merge_exposures(const reading& taken, Eigen::Index channel,
                                               const camera_response& response, const sensor_noise& noise,
                                               std::uint16_t saturation) {
  detail::require_times(taken.frames.size(), taken.times,
                        "a reading of " + std::to_string(taken.frames.size()) + " frames");
  noise.require_usable();
  const std::uint16_t limit = saturation > 0 ? saturation : response.largest_count();
  const Eigen::Index pixels = taken.frames.front().rows();
  std::vector<detail::exposed> usable;
  bool is_dark = true;
  for (Eigen::Index j = 0; j < std::ssize(taken.frames); ++j) {
    const camera_frame& frame = taken.frames[j];
    if (frame.rows() != pixels || pixels == 0)
      refuse("a reading's frames need the same number of pixels, at least one, not " + std::to_string(pixels) +
             " and " + std::to_string(frame.rows()));
    const auto counts = frame.col(channel);
    if (counts.maxCoeff() > 0) is_dark = false;
    if (counts.maxCoeff() == 0 || counts.maxCoeff() >= limit) continue;
    double exposure = 0.0, count = 0.0;
    for (const std::uint16_t each : counts) {
      exposure += each > 0 ? response.exposure(each) : 0.0;
      count += each;
    }
    const auto number = static_cast<double>(pixels);
    usable.push_back({taken.times[j], exposure / number, count / number});
  }
  const measured_radiance merged =
      detail::mean_radiance(std::move(usable), response, noise, limit, static_cast<double>(pixels));
  if (merged.value > 0.0) return merged;
  return is_dark ? detail::dark_radiance(response, taken.times)
                 : detail::saturated_radiance(response, taken.times, limit);
}

}  // namespace gonio::capture
