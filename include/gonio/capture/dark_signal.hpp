#pragma once
/// What a linear camera counts without light, from frames with the lens covered: of each pixel a pedestal and a
/// current, b + d t, fitted by least squares. Pixels whose counts stand out are hot. Model: J. Janesick, "Photon
/// Transfer", SPIE 2007, doi:10.1117/3.725073, chapter 7.

#include <gonio/table/stored_codes.hpp>

#include <Eigen/Core>

#include <span>
#include <vector>

namespace gonio::capture {

/// A frame and how long it was exposed.
struct exposed_frame {
  double seconds = 0.0;
  stored_codes codes;
};

namespace detail {

/// Throws gonio::error unless frames have one size and largest count, and times that are positive and finite; there
/// must be one at least. `what` names them: "a photograph".
void require_alike(std::span<const exposed_frame> frames, const char* what);

}  // namespace detail

/// The dark counts of all pixels and channels, and how well they are known. Without frames they are a level that is
/// given, the same everywhere, with no error.
class dark_signal {
 public:
  dark_signal() = default;
  explicit dark_signal(double level) : level_(level) {}

  /// Fits each value of the frames. Frames of one exposure time say nothing of others: all photographs then need that
  /// time, and the level holds the current too. Throws gonio::error if there is no frame, if frames differ in size or
  /// largest count, or if a time is not positive and finite. O(frames values).
  explicit dark_signal(std::span<const exposed_frame> frames);

  /// The counts of value `i` (as in stored_codes) in an exposure.
  [[nodiscard]] double count(Eigen::Index i, double seconds) const noexcept {
    return pedestals_.empty() ? level_ : pedestals_[i] + currents_[i] * seconds;
  }
  /// The median count of all values in no time at all.
  [[nodiscard]] double level() const noexcept { return level_; }
  /// The variance of `count`, as a multiple of the variance of one dark count.
  [[nodiscard]] double relative_variance(double seconds) const noexcept;
  /// Does it know of each pixel? If so, of how many values.
  [[nodiscard]] Eigen::Index size() const noexcept { return std::ssize(pedestals_); }
  /// The numbers of the pixels of which a channel, in the longest dark exposure, is more than eight robust deviations
  /// above the median, and more than four counts; in increasing order.
  [[nodiscard]] const std::vector<Eigen::Index>& hot_pixels() const noexcept { return hot_; }

  /// Throws gonio::error if all dark frames have one exposure time and this is another one, by more than 1 %.
  void require_known(double seconds) const;

 private:
  void fit(std::span<const exposed_frame> frames);
  void find_hot_pixels(double longest);

  double level_ = 0.0;
  double frames_ = 0.0, mean_time_ = 0.0, scatter_ = 0.0;  ///< number, mean and sum of squared deviations of the times
  std::vector<float> pedestals_, currents_;
  std::vector<Eigen::Index> hot_;
};

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/dark_signal.ipp>
#endif
