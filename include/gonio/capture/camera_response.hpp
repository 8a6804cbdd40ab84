#pragma once
/// What a camera's counts mean: the exposure that causes each, up to a factor (P. Debevec and J. Malik, "Recovering
/// High Dynamic Range Radiance Maps from Photographs", SIGGRAPH 1997, doi:10.1145/258734.258884; Nielsen's thesis 2016,
/// note on relative BRDF measurement, Sec. 3).

#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

namespace gonio::capture {

/// The logarithm of exposure as a function of counts from 0 to a largest one, for one colour channel. It never falls.
/// Exposures are relative: that of the middle count is 1.
///
/// Between its knots, which lie evenly over the counts, it is a straight line of the *logarithm* of the count, so that
/// a power law, every gamma and a linear sensor among them, is exact.
class camera_response {
 public:
  /// Values at the counts k c / n of the largest count c, k = 1 ... n. Throws gonio::error for less than two values,
  /// ones that fall or are not finite, and a largest count below n.
  /// What is below the first knot, and below `smallest_known_count`, is a guess.
  camera_response(std::uint16_t largest_count, Eigen::VectorXd log_exposures, double smallest_known_count = 0.0);

  /// A sensor whose counts are proportional to the exposure, or to its 1/gamma-th power.
  [[nodiscard]] static camera_response power_law(std::uint16_t largest_count, double gamma = 1.0);

  [[nodiscard]] std::uint16_t largest_count() const noexcept { return largest_; }
  /// Below it, exposures are extrapolated.
  [[nodiscard]] double smallest_known_count() const noexcept { return smallest_known_; }
  /// The values at the knots.
  [[nodiscard]] const Eigen::VectorXd& log_exposures() const noexcept { return values_; }

  /// ln X of a count, which need not be whole. Below the first knot its first line goes on; 0 counts are -infinity.
  [[nodiscard]] double log_exposure(double count) const noexcept {
    const auto [left, share] = place_of(count);
    return values_[left] + share * (values_[left + 1] - values_[left]);
  }
  [[nodiscard]] double exposure(double count) const noexcept { return std::exp(log_exposure(count)); }

  /// d ln X / d count: what an error of one count does to the logarithm of exposure.
  [[nodiscard]] double slope(double count) const noexcept {
    const Eigen::Index left = place_of(count).first;
    return (values_[left + 1] - values_[left]) / (std::log1p(1.0 / static_cast<double>(left + 1)) * count);
  }

  /// The count, not rounded, of an exposure; more than the largest count's gives that. The least of several.
  [[nodiscard]] double count(double exposure) const noexcept;

  /// Where a count lies: the knot on its left, counted from 0, and how far it is on the way to the next, in the
  /// logarithm of the count: less than 0 below the first knot.
  [[nodiscard]] std::pair<Eigen::Index, double> place_of(double count) const noexcept {
    return place_of(count, spacing(), values_.size());
  }
  [[nodiscard]] static std::pair<Eigen::Index, double> place_of(double count, double spacing,
                                                                Eigen::Index knots) noexcept;

  /// As many values as tell the cameras of 8 bits everything.
  static constexpr Eigen::Index most_knots = 64;

 private:
  [[nodiscard]] double spacing() const noexcept { return largest_ / static_cast<double>(values_.size()); }

  std::uint16_t largest_ = 0;
  double smallest_known_ = 0.0;
  Eigen::VectorXd values_;
};

/// Counts of some pixels, one row each, at some exposure times, one column each. Means of several pixels need not be
/// whole numbers.
using exposure_counts = Eigen::ArrayXXd;

struct response_options {
  /// Weight of the smoothness against the data, of which the mean square counts.
  double smoothness = 3e-6;
  /// From this count on a pixel is saturated; 0 stands for the largest count.
  std::uint16_t saturation = 0;
};

/// The response of a camera whose pixels were exposed for several times each: the g that minimises
///
///   sum w(Z_ij)^2 (g(Z_ij) - ln E_i - ln t_j)^2 / sum w^2 + smoothness * integral of (v(Z) d^2 g / d(ln Z)^2)^2
///
/// over g and the pixels' unknown E_i (Debevec and Malik 1997, Eq. 3), with their hat for w. Two things differ from the
/// paper. Smooth is what is close to a power law, where the paper's second difference by Z bends every camera at its
/// low counts; v is 1 in the lower half of the counts and the square of the hat above, where sensors bend. And g never
/// falls, by a linear constraint on its slopes.
///
/// Throws gonio::error unless there are two times, all positive and finite, a pixel, and pixels that tell two
/// exposures apart: neither dark nor saturated in at least two. O(pixels (times + knots^2) + knots^3).
[[nodiscard]] camera_response estimate_response(const exposure_counts& counts, std::span<const double> times,
                                                std::uint16_t largest_count, const response_options& options = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/camera_response.ipp>
#endif
