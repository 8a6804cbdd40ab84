#pragma once
/// Photographs of one scene at several exposure times as one radiance image, with the deviation and the state of each
/// value: the mean of what exposures say, with the inverse of their variances for weight (P. Debevec and J. Malik,
/// SIGGRAPH 1997, doi:10.1145/258734.258884, Eq. 6; variances: M. Granados et al., "Optimal HDR reconstruction with
/// linear digital cameras", CVPR 2010, doi:10.1109/CVPR.2010.5540208, Sec. 3).
///
/// `merge_exposures` does this for one pixel, or the mean of a goniometer's reading, without dark frames.

#include <gonio/capture/camera_response.hpp>
#include <gonio/capture/dark_signal.hpp>
#include <gonio/capture/high_dynamic_range.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace gonio::capture {

/// How far a value may be trusted; the later, the less.
enum class value_state : std::uint8_t {
  usable,
  dark,           ///< not told apart from black: less than two deviations
  contradictory,  ///< exposures disagree: something moved, or the noise is larger than stated
  hot,            ///< the dark frames show a hot pixel
  saturated       ///< in every exposure: the value is a lower bound
};

/// The radiance of each value up to the factor that responses leave open, exposure per second with that of the middle
/// count as 1, in the layout of `stored_codes`.
struct merged_frames {
  image radiance;
  image deviation;                  ///< standard deviation; infinite where saturated or hot
  std::vector<value_state> states;  ///< of each value

  /// The worst of a pixel's three.
  [[nodiscard]] value_state pixel_state(Eigen::Index pixel) const noexcept;
  /// Of how many pixels that is this state.
  [[nodiscard]] Eigen::Index count(value_state state) const noexcept;
};

struct merge_options {
  /// In counts of a linear camera of the same range: noise comes before the response. `relative` is of each exposure,
  /// and common to its pixels.
  sensor_noise noise{.read = 0.5, .shot = 0.0, .relative = 0.0};
  /// From this count on a value is saturated; 0 stands for the largest count.
  std::uint16_t saturation = 0;
  thread_count threads{};
};

/// The largest count that a response is of, if the counts begin at a dark level.
[[nodiscard]] std::uint16_t counts_above(std::uint16_t largest, const dark_signal& dark) noexcept;

/// Merges photographs of one scene. The dark level is taken off counts, what else is dark off exposures. Counts of 0
/// and from saturation on take no part; nor do exposures of which the mean predicts that noise reaches beyond these
/// limits, unless there are no others. `responses`, of red, green and blue, are of `counts_above` counts. What is black
/// may come out negative, as it must if it is to be right in the mean. The same bytes for any number of threads.
///
/// Throws gonio::error if there is no frame, if frames or dark frames differ in size or largest count, if a time is not
/// positive and finite, if responses are of other counts, if the dark frames do not cover an exposure time, if the
/// saturation is not above the dark level, or if every value of every frame is saturated. O(frames values).
[[nodiscard]] merged_frames merge_frames(std::span<const exposed_frame> frames,
                                         const std::array<camera_response, 3>& responses, const dark_signal& dark = {},
                                         const merge_options& options = {});

/// The responses of the three channels, by `estimate_response` from the mean counts of 400 groups of pixels of alike
/// radiance: single counts are noisy, and noise bends a response by a per cent and more. 200,000 pixels take part,
/// chosen by the seed. Dark current is not taken off.
///
/// Throws gonio::error as `estimate_response` does, and if frames differ in size or largest count. O(p (frames + log
/// p)) for p pixels.
[[nodiscard]] std::array<camera_response, 3> estimate_responses(std::span<const exposed_frame> frames,
                                                                const dark_signal& dark = {},
                                                                const response_options& options = {},
                                                                std::uint64_t seed = 1);

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/merged_frames.ipp>
#endif
