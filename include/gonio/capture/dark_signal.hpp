#pragma once
/// The dark counts of a linear camera, from frames with the lens covered. Fits a pedestal b and a current d to each
/// pixel by least squares: b + d t counts at the exposure time t. Pixels with outlying counts are hot. Model: J.
/// Janesick, "Photon Transfer", SPIE 2007, doi:10.1117/3.725073, chapter 7.

#include <gonio/table/stored_codes.hpp>

#include <Eigen/Core>

#include <span>
#include <vector>

namespace gonio::capture {

/// A frame and its exposure time.
struct exposed_frame {
  double seconds = 0.0;
  stored_codes codes;
};

namespace detail {

/// Throws gonio::error unless there is at least one frame, all frames have the same size and largest count, and all
/// times are positive and finite. `what` names a frame in messages: "a photograph".
void require_alike(std::span<const exposed_frame> frames, const char* what);

}  // namespace detail

/// The dark counts of all pixels and channels, and their uncertainty. Without frames, all values have one given level
/// without error.
class dark_signal {
 public:
  dark_signal() = default;
  explicit dark_signal(double level) : level_(level) {}

  /// Fits a pedestal and a dark current to each value. If all frames have the same exposure time, the two cannot be
  /// separated: the pedestal then includes the current, and every photograph must have this exposure time. Throws
  /// gonio::error if there is no frame, if frames differ in size or largest count, or if a time is not positive and
  /// finite. O(frames values).
  explicit dark_signal(std::span<const exposed_frame> frames);

  /// Returns the dark count of value `i` (as in stored_codes) at an exposure time in seconds.
  [[nodiscard]] double count(Eigen::Index i, double seconds) const noexcept {
    return pedestals_.empty() ? level_ : pedestals_[i] + currents_[i] * seconds;
  }
  /// Returns the dark level: the median of the pedestals of all values.
  [[nodiscard]] double level() const noexcept { return level_; }
  /// Returns the variance of `count` at an exposure time in seconds, relative to the variance of a single dark count.
  [[nodiscard]] double relative_variance(double seconds) const noexcept;
  /// Returns the number of values that have their own dark count; 0 for a given level.
  [[nodiscard]] Eigen::Index size() const noexcept { return std::ssize(pedestals_); }
  /// Returns the hot pixels, ascending. At the longest dark exposure, one of their channels exceeds the median by more
  /// than eight robust standard deviations and by more than four counts.
  [[nodiscard]] const std::vector<Eigen::Index>& hot_pixels() const noexcept { return hot_; }

  /// Throws gonio::error if all dark frames have the same exposure time and `seconds` differs from it by more than 1 %.
  void require_known(double seconds) const;

 private:
  void fit(std::span<const exposed_frame> frames);
  void find_hot_pixels(double longest);

  double level_ = 0.0;
  double frames_ = 0.0, mean_time_ = 0.0,
         scatter_ = 0.0;  ///< number, mean and sum of squared deviations of the exposure times
  std::vector<float> pedestals_, currents_;
  std::vector<Eigen::Index> hot_;
};

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/dark_signal.ipp>
#endif
