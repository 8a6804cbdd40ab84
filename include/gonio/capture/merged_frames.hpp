#pragma once
/// Merges photographs of one scene at several exposure times into a radiance image with the deviation and state of each
/// value. Takes the mean over the exposures, weighted by inverse variance (P. Debevec and J. Malik, SIGGRAPH 1997,
/// doi:10.1145/258734.258884, Eq. 6; variances: M. Granados et al., "Optimal HDR reconstruction with linear digital
/// cameras", CVPR 2010, doi:10.1109/CVPR.2010.5540208, Sec. 3).
///
/// `merge_exposures` merges exposures without dark frames, of one pixel or of the mean of a goniometer's reading.

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

/// The reliability of a value, in decreasing order.
enum class value_state : std::uint8_t {
  usable,
  dark,           ///< cannot be distinguished from black: less than two deviations
  contradictory,  ///< the exposures disagree: something moved, or the noise is larger than stated
  hot,            ///< a hot pixel of the dark frames
  saturated       ///< saturated in every exposure: the value is a lower bound
};

/// The radiance of each value as exposure per second, up to the unknown factor of the responses (the middle count of a
/// response has exposure 1). The layout is the same as in `stored_codes`.
struct merged_frames {
  image radiance;
  image deviation;                  ///< standard deviation; infinite if saturated or hot
  std::vector<value_state> states;  ///< state of each value

  /// Returns the worst state of a pixel's three values.
  [[nodiscard]] value_state pixel_state(Eigen::Index pixel) const noexcept;
  /// Returns the number of pixels in this state.
  [[nodiscard]] Eigen::Index count(value_state state) const noexcept;
};

struct merge_options {
  /// The noise in counts of a linear camera with the same range, because noise arises before the response. `relative`
  /// applies to each exposure and is common to its pixels.
  sensor_noise noise{.read = 0.5, .shot = 0.0, .relative = 0.0};
  /// Values are saturated from this count on; 0 stands for the largest count.
  std::uint16_t saturation = 0;
  thread_count threads{};
};

/// Returns the largest count above the dark level. It is the range of the responses.
[[nodiscard]] std::uint16_t counts_above(std::uint16_t largest, const dark_signal& dark) noexcept;

/// Merges photographs of one scene. Subtracts the dark level from the counts, and the remaining dark signal from the
/// exposures. Ignores counts of 0 and counts from `saturation` on. Also ignores exposures whose predicted noise reaches
/// outside these limits, unless that excludes all exposures. `responses` (red, green, blue) must have the range
/// `counts_above`. Black values may be negative, because clipping would bias them. The bytes do not depend on the
/// number of threads.
///
/// Throws gonio::error if there is no frame, if frames or dark frames differ in size or largest count, if a time is not
/// positive and finite, if a response has another range, if the dark frames do not cover an exposure time, if the
/// saturation is not above the dark level, or if every value of every frame is saturated. O(frames values).
[[nodiscard]] merged_frames merge_frames(std::span<const exposed_frame> frames,
                                         const std::array<camera_response, 3>& responses, const dark_signal& dark = {},
                                         const merge_options& options = {});

/// Estimates the responses of the three channels with `estimate_response` from the mean counts of 400 groups of pixels
/// with similar radiance. The noise of single counts would bend a response by 1 % or more. Uses 200,000 pixels, chosen
/// by the seed. Does not subtract the dark current.
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
