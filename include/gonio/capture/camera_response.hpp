#pragma once
/// What a camera's counts mean: the exposure that causes each, up to a factor (P. Debevec and J. Malik, "Recovering
/// High Dynamic Range Radiance Maps from Photographs", SIGGRAPH 1997; Nielsen's thesis 2016, note on relative BRDF
/// measurement, Sec. 3).

#include <gonio/core/error.hpp>
#include <gonio/solve/quadratic_program.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

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
  double smoothness = 1e-5;
  /// From this count on a pixel is saturated; 0 stands for the largest count.
  std::uint16_t saturation = 0;
};

namespace detail {

/// 0 at both ends of a camera's range, 1 in its middle (Debevec and Malik 1997, Eq. 4).
[[nodiscard]] inline double hat(double count, double saturation) noexcept {
  return std::max(0.0, 1.0 - std::abs(2.0 * count / saturation - 1.0));
}

/// The response at the knots, but for a constant, is G s, and its slopes by the logarithm of the count are S s, where s
/// is the first slope and then one bend for each knot but the ends, of which the sum of squares is the integral that
/// smoothness weighs. In these unknowns it is a multiple of the identity, and the problem well-conditioned.
struct response_basis {
  Eigen::MatrixXd values, slopes;  ///< G: knots x (knots - 1), S: (knots - 1) x (knots - 1)

  explicit response_basis(Eigen::Index knots);
};

/// The normal equations of what the counts say of the response at its knots. Of each pixel, the unknown ln E is the
/// weighted mean of what its rows say, so that only the response is left.
class response_equations {
 public:
  response_equations(Eigen::Index knots, double spacing, double saturation);

  /// A pixel's counts, one for each time.
  template <class Counts>
  void add(const Counts& counts, const Eigen::VectorXd& log_times) {
    Eigen::VectorXd row_sum = Eigen::VectorXd::Zero(moment_.size());
    double weights = 0.0, time_sum = 0.0, darkest = smallest_count_;
    int rows = 0;
    for (Eigen::Index j = 0; j < counts.size(); ++j) {
      const double weight = std::pow(hat(counts[j], saturation_), 2);
      if (!(weight > 0.0)) continue;
      const auto [left, share] = camera_response::place_of(counts[j], spacing_, moment_.size());
      const Eigen::Vector2d row(1.0 - share, share);
      gram_.block<2, 2>(left, left) += weight * row * row.transpose();
      moment_.segment<2>(left) += weight * log_times[j] * row;
      darkest = std::min(darkest, static_cast<double>(counts[j]));
      row_sum.segment<2>(left) += weight * row;
      time_sum += weight * log_times[j];
      weights += weight;
      ++rows;
    }
    if (rows == 0) return;
    gram_ -= row_sum * row_sum.transpose() / weights;
    moment_ -= time_sum / weights * row_sum;
    if (rows < 2) return;
    weight_ += weights;
    smallest_count_ = darkest;
  }

  [[nodiscard]] const Eigen::MatrixXd& gram() const noexcept { return gram_; }
  [[nodiscard]] const Eigen::VectorXd& moment() const noexcept { return moment_; }
  /// Of all rows of pixels that have two or more: one alone says nothing.
  [[nodiscard]] double weight() const noexcept { return weight_; }
  /// Of the same rows.
  [[nodiscard]] double smallest_count() const noexcept { return smallest_count_; }

 private:
  Eigen::MatrixXd gram_;
  Eigen::VectorXd moment_;
  double spacing_ = 1.0, saturation_ = 1.0, weight_ = 0.0;
  double smallest_count_ = std::numeric_limits<double>::infinity();
};

/// Takes away what rounding lets a value fall by.
[[nodiscard]] Eigen::VectorXd never_falling(Eigen::VectorXd values);

}  // namespace detail

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

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/camera_response.ipp>
#endif
