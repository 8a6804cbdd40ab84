#pragma once
/// The response of a camera: the exposure of each count, up to a factor (P. Debevec and J. Malik, "Recovering High
/// Dynamic Range Radiance Maps from Photographs", SIGGRAPH 1997, doi:10.1145/258734.258884; Nielsen's thesis 2016, note
/// on relative BRDF measurement, Sec. 3).

#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

namespace gonio::capture {

/// The logarithm of exposure as a function of the count, from 0 to the largest count, for one colour channel. It never
/// decreases. Exposures are relative: the middle count has exposure 1.
///
/// Between its knots, which are evenly spaced over the counts, the response is linear in the *logarithm* of the count.
/// Power laws, such as a gamma or a linear sensor, are therefore exact.
class camera_response {
 public:
  /// Takes the values at n knots, the counts k c / n for k = 1 ... n, where c is the largest count. Values below the
  /// first knot and below `smallest_known_count` are extrapolated. Throws gonio::error for fewer than two values,
  /// decreasing or non-finite values, and a largest count below n.
  camera_response(std::uint16_t largest_count, Eigen::VectorXd log_exposures, double smallest_known_count = 0.0);

  /// Returns the response of a sensor whose counts are proportional to the exposure, or to its 1/gamma-th power.
  [[nodiscard]] static camera_response power_law(std::uint16_t largest_count, double gamma = 1.0);

  [[nodiscard]] std::uint16_t largest_count() const noexcept { return largest_; }
  /// Returns the count below which exposures are extrapolated.
  [[nodiscard]] double smallest_known_count() const noexcept { return smallest_known_; }
  /// Returns the logarithms of exposure at the knots.
  [[nodiscard]] const Eigen::VectorXd& log_exposures() const noexcept { return values_; }

  /// Returns ln X of a count, which may be fractional, where X is the exposure. Below the first knot, extends the line
  /// between the first two knots; a count of 0 gives -infinity.
  [[nodiscard]] double log_exposure(double count) const noexcept {
    const auto [left, share] = knot_position(count);
    return values_[left] + share * (values_[left + 1] - values_[left]);
  }
  [[nodiscard]] double exposure(double count) const noexcept { return std::exp(log_exposure(count)); }

  /// Returns d ln X / d count: the effect of an error of one count on the logarithm of exposure.
  [[nodiscard]] double slope(double count) const noexcept {
    const Eigen::Index left = knot_position(count).first;
    return (values_[left + 1] - values_[left]) / (std::log1p(1.0 / static_cast<double>(left + 1)) * count);
  }

  /// Returns the unrounded count of an exposure, at most the largest count. If several counts have this exposure,
  /// returns the smallest.
  [[nodiscard]] double count(double exposure) const noexcept;

  /// Returns the knot to the left of a count, from 0, and the fraction of the way to the next knot in the logarithm of
  /// the count. The fraction is negative below the first knot.
  [[nodiscard]] std::pair<Eigen::Index, double> knot_position(double count) const noexcept {
    return knot_position(count, spacing(), values_.size());
  }
  [[nodiscard]] static std::pair<Eigen::Index, double> knot_position(double count, double spacing,
                                                                     Eigen::Index knots) noexcept;

  /// The largest number of knots, enough for all 8-bit cameras.
  static constexpr Eigen::Index most_knots = 64;

 private:
  [[nodiscard]] double spacing() const noexcept { return largest_ / static_cast<double>(values_.size()); }

  std::uint16_t largest_ = 0;
  double smallest_known_ = 0.0;
  Eigen::VectorXd values_;
};

/// Counts of some pixels (rows) at some exposure times (columns). Means over pixels may be fractional.
using exposure_counts = Eigen::ArrayXXd;

struct response_options {
  /// The smallest weight of the smoothness term; the mean squared residual of the data has the weight 1.
  double smoothness = 3e-6;
  /// The expected smoothness integral of a camera: noise of few exposures must not bend the response more than that.
  double expected_bend = 0.05;
  /// Pixels are saturated from this count on; 0 stands for the largest count.
  std::uint16_t saturation = 0;
};

/// Estimates the response g of a camera whose pixels were each exposed at several exposure times. g minimises
///
///   sum w(Z_ij)^2 (g(Z_ij) - ln E_i - ln t_j)^2 / sum w^2 + s * integral of (v(Z) d^2 g / d(ln Z)^2)^2
///
/// over g and the pixels' unknown E_i (Debevec and Malik 1997, Eq. 3), with their hat function for w. Z_ij is the count
/// of pixel i at the time t_j. The objective differs from the paper's in two ways. First, smoothness means closeness to
/// a power law; the paper's second difference with respect to Z would bend every response at low counts. v is 1 in the
/// lower half of the counts; in the upper half, where sensors bend, it is the square of the hat function. Second, a
/// linear constraint on the slopes keeps g from decreasing. A first fit with s = `smoothness` measures the mean squared
/// residual r of the data. For the second fit, s grows by r / (expected_bend * sum w^2).
///
/// Throws gonio::error unless there are at least two times, all positive and finite, and at least one pixel that is
/// neither dark nor saturated in two exposures. O(pixels (times + knots^2) + knots^3).
[[nodiscard]] camera_response estimate_response(const exposure_counts& counts, std::span<const double> times,
                                                std::uint16_t largest_count, const response_options& options = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/camera_response.ipp>
#endif
