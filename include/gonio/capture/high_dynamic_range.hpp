#pragma once
/// Merges several exposures of a pixel into one radiance with its uncertainty (P. Debevec and J. Malik, "Recovering
/// High Dynamic Range Radiance Maps from Photographs", SIGGRAPH 1997, doi:10.1145/258734.258884, Eq. 6).

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

/// The noise of a camera's counts.
struct sensor_noise {
  double read = 0.5;       ///< standard deviation in counts, at every count
  double shot = 0.0;       ///< variance in counts^2 per count of signal
  double relative = 0.01;  ///< standard deviation relative to the exposure: of the lamp and of the exposure time

  /// Throws gonio::error if a number is negative or not finite.
  void require_usable() const;

  /// Returns the relative variance of the exposure at a count, using the slope of the camera's response. Rounding to
  /// whole counts adds a variance of 1/12. Averaging `pixels` pixels reduces these variances, but not the variance of
  /// the lamp and of the exposure time.
  [[nodiscard]] double relative_variance(const camera_response& response, double count,
                                         double pixels = 1.0) const noexcept;
};

/// The radiance of a pixel: exposure per second, up to the unknown factor of the response.
struct measured_radiance {
  double value = 0.0;
  double deviation = 0.0;  ///< standard deviation of the value
  bool saturated = false;  ///< even in the shortest exposure; the value is a lower bound, its deviation infinite
  bool dark = false;       ///< even in the longest exposure; the value is 0, its deviation the radiance of one count

  [[nodiscard]] bool usable() const noexcept { return !saturated && !dark; }
};

namespace detail {

/// One exposure of a pixel, or of the mean of several pixels: its time, exposure and count.
struct exposed {
  double time = 0.0, exposure = 0.0, count = 0.0;
};

/// Returns the mean radiance of several exposures, weighted by their inverse variances. Uses the variances at the
/// counts that the mean predicts. With those at the measured counts, an exposure that noise made darker would count
/// more, and so would a saturated pixel that noise kept below saturation. Counts at which the response is extrapolated
/// are used only if there are no others. Value and deviation are 0 if there is no exposure.
[[nodiscard]] measured_radiance mean_radiance(std::vector<exposed> all, const camera_response& response,
                                              const sensor_noise& noise, double saturation, double pixels);

void require_times(Eigen::Index images, std::span<const double> times, const std::string& what);

/// Returns the radiance of a pixel that is dark even in the longest exposure.
[[nodiscard]] inline measured_radiance dark_radiance(const camera_response& response, std::span<const double> times) {
  return {0.0, response.exposure(1.0) / std::ranges::max(times), false, true};
}
/// Returns the radiance of a pixel that is saturated even in the shortest exposure.
[[nodiscard]] measured_radiance saturated_radiance(const camera_response& response, std::span<const double> times,
                                                   std::uint16_t saturation);

}  // namespace detail

/// Returns the radiance of a pixel from its counts at several exposure times: the mean over the exposures, weighted by
/// inverse variance. Ignores counts of 0 and counts from `saturation` on (0 stands for the largest count).
///
/// Throws gonio::error unless there is one time for each count, at least one, and all times are positive and finite.
/// O(times).
[[nodiscard]] measured_radiance merge_exposures(std::span<const std::uint16_t> counts, std::span<const double> times,
                                                const camera_response& response, const sensor_noise& noise = {},
                                                std::uint16_t saturation = 0);

/// Returns the mean radiance of all pixels of a reading in one channel (0 to 2). Merges the exposures of the pixels'
/// mean as for one pixel. Ignores a frame if any pixel is saturated, because the remaining pixels would have a
/// different mean.
///
/// Throws gonio::error unless the reading has one time for each frame, at least one, and all frames have the same
/// number of pixels, at least one. O(times pixels).
[[nodiscard]] measured_radiance merge_exposures(const reading& taken, Eigen::Index channel,
                                                const camera_response& response, const sensor_noise& noise = {},
                                                std::uint16_t saturation = 0);

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/high_dynamic_range.ipp>
#endif
