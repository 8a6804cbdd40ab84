#pragma once
/// Bodies of capture/dark_signal.hpp.

#include <gonio/capture/dark_signal.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/statistics.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace gonio::capture::detail {

GONIO_INLINE void require_alike(std::span<const exposed_frame> frames, const char* what) {
  if (frames.empty()) refuse({"there is no frame: ", what, " is needed"});
  const stored_codes& first = frames.front().codes;
  for (const auto& [seconds, codes] : frames) {
    if (!(seconds > 0.0 && std::isfinite(seconds)))
      refuse({"an exposure time must be positive and finite, not ", seconds});
    if (codes.rows != first.rows || codes.columns != first.columns)
      refuse({what, " has ", codes.columns, " x ", codes.rows, " pixels, but the first has ", first.columns, " x ",
              first.rows});
    if (codes.largest != first.largest)
      refuse({what, " counts up to ", int{codes.largest}, ", but the first counts up to ", int{first.largest}});
    if (codes.values.size() != 3 * codes.rows * codes.columns || codes.values.empty())
      refuse({what, " has ", codes.values.size(), " counts, expected ", 3 * codes.rows * codes.columns,
              ", and at least one pixel"});
  }
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE dark_signal::dark_signal(std::span<const exposed_frame> frames) {
  detail::require_alike(frames, "a dark frame");
  frames_ = static_cast<double>(frames.size());
  double longest = 0.0;
  for (const exposed_frame& each : frames) {
    mean_time_ += each.seconds / frames_;
    longest = std::max(longest, each.seconds);
  }
  for (const exposed_frame& each : frames) scatter_ += std::pow(each.seconds - mean_time_, 2);
  if (scatter_ < frames_ * std::pow(0.01 * mean_time_, 2))
    scatter_ = 0.0;  // the same exposure time, up to a camera's rounding
  fit(frames);
  level_ = upper_median(std::vector<float>(pedestals_));
  find_hot_pixels(longest);
}

/// Fits a line over the exposure time to the counts of each value, or a constant if there is only one exposure time.
GONIO_INLINE void dark_signal::fit(std::span<const exposed_frame> frames) {
  const Eigen::Index values = std::ssize(frames.front().codes.values);
  pedestals_.resize(values);
  currents_.resize(values);
  for (Eigen::Index i = 0; i < values; ++i) {
    double mean = 0.0, slope = 0.0;
    for (const auto& [seconds, codes] : frames) {
      mean += codes.values[i] / frames_;
      slope += (seconds - mean_time_) * codes.values[i];
    }
    slope = scatter_ > 0.0 ? slope / scatter_ : 0.0;
    currents_[i] = static_cast<float>(slope);
    pedestals_[i] = static_cast<float>(mean - slope * mean_time_);
  }
}

GONIO_INLINE void dark_signal::find_hot_pixels(double longest) {
  constexpr double deviations = 8.0, counts = 4.0;
  std::vector<double> dark(pedestals_.size());
  for (Eigen::Index i = 0; i < size(); ++i) dark[i] = count(i, longest);
  const double middle = upper_median(std::vector<double>(dark));
  std::vector<double> distances;
  distances.reserve(dark.size());
  for (const double each : dark) distances.push_back(std::abs(each - middle));
  const double limit = middle + std::max(counts, deviations * deviation_by_median * upper_median(distances));
  for (Eigen::Index pixel = 0; pixel < size() / 3; ++pixel)
    if (std::max({dark[3 * pixel], dark[3 * pixel + 1], dark[3 * pixel + 2]}) > limit) hot_.push_back(pixel);
}

GONIO_INLINE double dark_signal::relative_variance(double seconds) const noexcept {
  if (pedestals_.empty()) return 0.0;
  return 1.0 / frames_ + (scatter_ > 0.0 ? std::pow(seconds - mean_time_, 2) / scatter_ : 0.0);
}

GONIO_INLINE void dark_signal::require_known(double seconds) const {
  constexpr double tolerance = 0.01;
  if (pedestals_.empty() || scatter_ > 0.0 || std::abs(seconds - mean_time_) <= tolerance * mean_time_) return;
  refuse({"all dark frames are exposed for ", mean_time_, " s, the photograph for ", seconds,
          " s: dark frames of two exposure times are needed"});
}

}  // namespace gonio::capture
