#pragma once
/// Several exposures of a pixel as one radiance, and how far to trust it (P. Debevec and J. Malik, "Recovering High
/// Dynamic Range Radiance Maps from Photographs", SIGGRAPH 1997, Eq. 6).

#include <gonio/capture/camera_response.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>

namespace gonio {

/// What a camera's counts vary by.
struct sensor_noise {
  double read = 0.5;       ///< deviation in counts, of every count
  double shot = 0.0;       ///< variance in counts for each count
  double relative = 0.01;  ///< deviation of each exposure relative to it: of the lamp and of the exposure time

  /// Throws gonio::error if a number is negative or not finite.
  void require_usable() const {
    for (const double number : {read, shot, relative})
      if (!(number >= 0.0 && std::isfinite(number)))
        throw error("a sensor's noise must be finite and not negative, not " + std::to_string(number));
  }

  /// The relative variance of the exposure that gives a count, by the slope of the camera's response there. A count is
  /// a whole number: that alone is a variance of 1/12.
  [[nodiscard]] double relative_variance(const camera_response& response, double count) const noexcept {
    constexpr double rounding = 1.0 / 12.0;
    const double slope = response.slope(count);
    return slope * slope * (read * read + shot * count + rounding) + relative * relative;
  }
};

/// What is known of a pixel: exposure per second, up to the factor that a response leaves open.
struct measured_radiance {
  double value = 0.0;
  double deviation = 0.0;  ///< standard deviation of the value
  bool saturated = false;  ///< even the shortest exposure: the value is a lower bound, its deviation infinite
  bool dark = false;       ///< even the longest exposure: the value is 0, the deviation that of one count

  [[nodiscard]] bool usable() const noexcept { return !saturated && !dark; }
};

/// The radiance of a pixel from its counts at several exposure times: the mean of what each exposure says, with the
/// inverse of its variance for weight. The variances are those of the counts that the mean predicts: those of the
/// counts themselves would favour what noise made darker, and let through of what saturates the dark half. Counts of 0
/// and from `saturation` on (0 stands for the largest count) take no part.
///
/// Throws gonio::error unless there are as many times as counts, at least one, all positive and finite. O(times).
[[nodiscard]] inline measured_radiance merge_exposures(std::span<const std::uint16_t> counts,
                                                       std::span<const double> times, const camera_response& response,
                                                       const sensor_noise& noise = {}, std::uint16_t saturation = 0) {
  if (counts.size() != times.size() || times.empty())
    throw error("a pixel of " + std::to_string(counts.size()) + " counts needs as many exposure times, not " +
                std::to_string(times.size()) + ", and at least one");
  noise.require_usable();
  for (const double time : times)
    if (!(time > 0.0 && std::isfinite(time)))
      throw error("an exposure time must be positive, not " + std::to_string(time));
  const std::uint16_t limit = saturation > 0 ? saturation : response.largest_count();

  const auto mean = [&](const auto& count_of) {
    double weights = 0.0, sum = 0.0;
    for (std::size_t j = 0; j < counts.size(); ++j) {
      if (counts[j] == 0 || counts[j] >= limit) continue;
      const double radiance = response.exposure(counts[j]) / times[j];
      const double expected = count_of(j), predicted = response.exposure(expected) / times[j];
      if (expected >= limit) continue;  // noise made it darker than what saturates
      const double weight = 1.0 / (predicted * predicted * noise.relative_variance(response, expected));
      weights += weight;
      sum += weight * radiance;
    }
    return std::pair(weights > 0.0 ? sum / weights : 0.0, weights);
  };
  auto [value, weights] = mean([&](std::size_t j) { return static_cast<double>(counts[j]); });
  if (!(weights > 0.0)) {
    const auto [shortest, longest] = std::ranges::minmax(times);
    if (std::ranges::all_of(counts, [](std::uint16_t count) { return count == 0; }))
      return {0.0, response.exposure(1.0) / longest, false, true};
    return {response.exposure(limit) / shortest, std::numeric_limits<double>::infinity(), true, false};
  }
  for (int pass = 0; pass < 2; ++pass) {
    const auto [better, certainty] =
        mean([&](std::size_t j) { return std::max(response.count(value * times[j]), 0.5); });
    if (!(certainty > 0.0)) break;
    value = better;
    weights = certainty;
  }
  return {value, 1.0 / std::sqrt(weights), false, false};
}

}  // namespace gonio
