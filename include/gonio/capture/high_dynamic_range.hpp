#pragma once
/// Several exposures of a pixel as one radiance, and how far to trust it (P. Debevec and J. Malik, "Recovering High
/// Dynamic Range Radiance Maps from Photographs", SIGGRAPH 1997, Eq. 6).

#include <gonio/capture/camera_response.hpp>
#include <gonio/capture/device.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

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
  /// a whole number: that alone is a variance of 1/12. The mean of several pixels has less of all that, but shares the
  /// lamp and the exposure time.
  [[nodiscard]] double relative_variance(const camera_response& response, double count,
                                         double pixels = 1.0) const noexcept {
    constexpr double rounding = 1.0 / 12.0;
    const double slope = response.slope(count);
    return slope * slope * (read * read + shot * count + rounding) / pixels + relative * relative;
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

namespace detail {

/// What a picture says of a radiance: how long it was exposed, the exposure, and the count, of one pixel or the mean.
struct exposed {
  double time = 0.0, exposure = 0.0, count = 0.0;
};

/// The mean of what exposures say, with the inverse of their variances for weight. The variances are those of the
/// counts that the mean predicts: those of the counts themselves would favour what noise made darker, and let through
/// of what saturates the dark half. Counts at which the response is a guess take part only if there are no others. Both
/// numbers are 0 if there is none.
[[nodiscard]] inline measured_radiance mean_radiance(std::vector<exposed> all, const camera_response& response,
                                                     const sensor_noise& noise, double saturation, double pixels) {
  const auto is_guess = [&](const exposed& each) { return each.count < response.smallest_known_count(); };
  if (!std::ranges::all_of(all, is_guess)) std::erase_if(all, is_guess);
  const auto mean = [&](const auto& expected_count) {
    double weights = 0.0, sum = 0.0;
    for (const exposed& each : all) {
      const double expected = expected_count(each);
      if (expected >= saturation) continue;  // noise made it darker than what saturates
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

inline void require_times(std::size_t pictures, std::span<const double> times, const std::string& what) {
  if (pictures != times.size() || times.empty())
    throw error(what + " needs as many exposure times, not " + std::to_string(times.size()) + ", and at least one");
  for (const double time : times)
    if (!(time > 0.0 && std::isfinite(time)))
      throw error("an exposure time must be positive, not " + std::to_string(time));
}

/// Even the longest exposure shows nothing.
[[nodiscard]] inline measured_radiance dark_radiance(const camera_response& response, std::span<const double> times) {
  return {0.0, response.exposure(1.0) / std::ranges::max(times), false, true};
}
/// Even the shortest exposure shows too much.
[[nodiscard]] inline measured_radiance saturated_radiance(const camera_response& response,
                                                          std::span<const double> times, std::uint16_t saturation) {
  return {response.exposure(saturation) / std::ranges::min(times), std::numeric_limits<double>::infinity(), true,
          false};
}

}  // namespace detail

/// The radiance of a pixel from its counts at several exposure times: the mean of what each exposure says, with the
/// inverse of its variance for weight. Counts of 0 and from `saturation` on (0 stands for the largest count) take no
/// part.
///
/// Throws gonio::error unless there are as many times as counts, at least one, all positive and finite. O(times).
[[nodiscard]] inline measured_radiance merge_exposures(std::span<const std::uint16_t> counts,
                                                       std::span<const double> times, const camera_response& response,
                                                       const sensor_noise& noise = {}, std::uint16_t saturation = 0) {
  detail::require_times(counts.size(), times, "a pixel of " + std::to_string(counts.size()) + " counts");
  noise.require_usable();
  const std::uint16_t limit = saturation > 0 ? saturation : response.largest_count();
  std::vector<detail::exposed> usable;
  for (std::size_t j = 0; j < counts.size(); ++j)
    if (counts[j] > 0 && counts[j] < limit)
      usable.push_back({times[j], response.exposure(counts[j]), static_cast<double>(counts[j])});
  const measured_radiance merged = detail::mean_radiance(std::move(usable), response, noise, limit, 1.0);
  if (merged.value > 0.0) return merged;
  if (std::ranges::all_of(counts, [](std::uint16_t count) { return count == 0; }))
    return detail::dark_radiance(response, times);
  return detail::saturated_radiance(response, times, limit);
}

/// The mean radiance of all pixels of a reading in one channel (0 to 2): merged as above, but of the exposures that the
/// pixels have on average. A frame of which a pixel saturates takes no part, as the mean of the others would be another
/// one.
///
/// Throws gonio::error unless the reading has as many times as frames, at least one, and all its frames the same number
/// of pixels, at least one. O(times pixels).
[[nodiscard]] inline measured_radiance merge_exposures(const reading& taken, Eigen::Index channel,
                                                       const camera_response& response, const sensor_noise& noise = {},
                                                       std::uint16_t saturation = 0) {
  detail::require_times(taken.frames.size(), taken.times,
                        "a reading of " + std::to_string(taken.frames.size()) + " frames");
  noise.require_usable();
  const std::uint16_t limit = saturation > 0 ? saturation : response.largest_count();
  const Eigen::Index pixels = taken.frames.front().rows();
  std::vector<detail::exposed> usable;
  bool is_dark = true;
  for (std::size_t j = 0; j < taken.frames.size(); ++j) {
    const camera_frame& picture = taken.frames[j];
    if (picture.rows() != pixels || pixels == 0)
      throw error("a reading's frames need the same number of pixels, at least one, not " + std::to_string(pixels) +
                  " and " + std::to_string(picture.rows()));
    const auto counts = picture.col(channel);
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

}  // namespace gonio
