#pragma once
/// Several exposures of a pixel as one radiance, and how far to trust it (P. Debevec and J. Malik, "Recovering High
/// Dynamic Range Radiance Maps from Photographs", SIGGRAPH 1997, doi:10.1145/258734.258884, Eq. 6).

#include <gonio/capture/camera_response.hpp>
#include <gonio/capture/device.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::capture {

/// What a camera's counts vary by.
struct sensor_noise {
  double read = 0.5;       ///< deviation in counts, of every count
  double shot = 0.0;       ///< variance in counts for each count
  double relative = 0.01;  ///< deviation of each exposure relative to it: of the lamp and of the exposure time

  /// Throws gonio::error if a number is negative or not finite.
  void require_usable() const;

  /// The relative variance of the exposure that gives a count, by the slope of the camera's response there. A count is
  /// a whole number: that alone is a variance of 1/12. The mean of several pixels has less of all that, but shares the
  /// lamp and the exposure time.
  [[nodiscard]] double relative_variance(const camera_response& response, double count,
                                         double pixels = 1.0) const noexcept;
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

/// What an image says of a radiance: how long it was exposed, the exposure, and the count, of one pixel or the mean.
struct exposed {
  double time = 0.0, exposure = 0.0, count = 0.0;
};

/// The mean of what exposures say, with the inverse of their variances for weight. The variances are those of the
/// counts that the mean predicts: those of the counts themselves would favour what noise made darker, and let through
/// of what saturates the dark half. Counts at which the response is a guess take part only if there are no others. Both
/// numbers are 0 if there is none.
[[nodiscard]] measured_radiance mean_radiance(std::vector<exposed> all, const camera_response& response,
                                              const sensor_noise& noise, double saturation, double pixels);

void require_times(Eigen::Index images, std::span<const double> times, const std::string& what);

/// Even the longest exposure shows nothing.
[[nodiscard]] inline measured_radiance dark_radiance(const camera_response& response, std::span<const double> times) {
  return {0.0, response.exposure(1.0) / std::ranges::max(times), false, true};
}
/// Even the shortest exposure shows too much.
[[nodiscard]] measured_radiance saturated_radiance(const camera_response& response, std::span<const double> times,
                                                   std::uint16_t saturation);

}  // namespace detail

/// The radiance of a pixel from its counts at several exposure times: the mean of what each exposure says, with the
/// inverse of its variance for weight. Counts of 0 and from `saturation` on (0 stands for the largest count) take no
/// part.
///
/// Throws gonio::error unless there are as many times as counts, at least one, all positive and finite. O(times).
[[nodiscard]] measured_radiance merge_exposures(std::span<const std::uint16_t> counts, std::span<const double> times,
                                                const camera_response& response, const sensor_noise& noise = {},
                                                std::uint16_t saturation = 0);

/// The mean radiance of all pixels of a reading in one channel (0 to 2): merged as above, but of the exposures that the
/// pixels have on average. A frame of which a pixel saturates takes no part, as the mean of the others would be another
/// one.
///
/// Throws gonio::error unless the reading has as many times as frames, at least one, and all its frames the same number
/// of pixels, at least one. O(times pixels).
[[nodiscard]] measured_radiance merge_exposures(const reading& taken, Eigen::Index channel,
                                                const camera_response& response, const sensor_noise& noise = {},
                                                std::uint16_t saturation = 0);

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/high_dynamic_range.ipp>
#endif
