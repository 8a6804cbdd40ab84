#pragma once
/// Measurements as a mixture of inliers, which scatter about an estimate, and of outliers. Outliers follow a smoothed
/// density of all measured values. What Noell, Koehler and Stricker 2014, section 2.3, choose by hand (gamma,
/// "depending on the dynamic range and the outlier ratio") is estimated here from the residuals by expectation and
/// maximisation (Dempster, Laird and Rubin 1977, doi:10.1111/j.2517-6161.1977.tb01600.x); inliers' residuals follow
/// Student's t (Lange, Little and Taylor 1989, doi:10.1080/01621459.1989.10478852).

#include <gonio/core/parallel.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/sample_regions.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

namespace gonio {

/// The density of logarithms of measurements, smoothed and flattened, over their range: what an outlier looks like. Its
/// square root, normalised, is halfway between the density of all measurements, under which no residual would be needed
/// to explain them, and a constant, under which a genuine highlight would be no less likely an outlier than any value.
class outlier_density {
 public:
  /// O(n). `logarithms` must not be empty.
  explicit outlier_density(const std::vector<double>& logarithms);

  [[nodiscard]] double operator()(double logarithm) const noexcept {
    const auto bin = static_cast<std::ptrdiff_t>((logarithm - lowest_) / step_);
    return density_[std::clamp<std::ptrdiff_t>(bin, 0, std::ssize(density_) - 1)];
  }

 private:
  static constexpr Eigen::Index bins = 200;
  double lowest_, step_;
  std::vector<double> density_;
};

inline outlier_density::outlier_density(const std::vector<double>& logarithms) : density_(bins, 0.0) {
  // Count in bins over the range and half a unit beyond.
  const auto [least, most] = std::ranges::minmax_element(logarithms);
  const auto n = static_cast<double>(logarithms.size());
  lowest_ = *least - 0.5;
  step_ = (*most - *least + 1.0) / static_cast<double>(bins);
  std::vector<double> counts(bins, 0.0);
  double mean = 0.0, square = 0.0;
  for (const double value : logarithms) {
    counts[std::min(bins - 1, static_cast<Eigen::Index>((value - lowest_) / step_))] += 1.0;
    mean += value / n;
    square += value * value / n;
  }
  // Smooth by a Gaussian of Silverman's width.
  const double deviation = std::sqrt(std::max(square - mean * mean, 0.0));
  const double width = std::max(1.06 * deviation * std::pow(n, -0.2), step_);
  const auto reach = static_cast<std::ptrdiff_t>(3.0 * width / step_) + 1;
  for (std::ptrdiff_t i = 0; i < std::ssize(counts); ++i)
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(i - reach, 0); j <= std::min(i + reach, std::ssize(counts) - 1);
         ++j) {
      const double z = static_cast<double>(i - j) * step_ / width;
      density_[j] += counts[i] * std::exp(-0.5 * z * z);
    }
  // Flatten: a tenth of a measurement is where nothing was measured.
  double total = 0.0;
  for (double& value : density_) {
    value = std::sqrt(std::max(value / (n * width * std::sqrt(2.0 * std::numbers::pi)), 0.1 / n));
    total += value * step_;
  }
  for (double& value : density_) value /= total;
}

/// Good residuals are `scale` times a variable of Student's t with 4 degrees of freedom, whose tails let the fit be
/// wrong somewhere; all others are outliers. Residuals and what is known of them are numbers, or arrays of them.
struct outlier_mixture {
  double inlier_fraction = 0.8;
  double scale = 0.3;  ///< of the logarithm of reflectance

  static constexpr double degrees_of_freedom = 4.0;
  /// A percent: no basis is better, and a scale of zero would be certain of everything.
  static constexpr double smallest_scale = 0.01;

  /// The density of a good residual.
  template <class Number>
  [[nodiscard]] Number good_density(const Number& residual) const {
    using std::sqrt;
    const Number tail = tail_weight(residual);
    return (0.375 / scale) * (tail * tail * sqrt(tail));
  }

  /// The probability that a measurement is good, given its residual and the density of outliers there.
  template <class Number>
  [[nodiscard]] Number probability(const Number& residual, const Number& outliers) const {
    const Number good = inlier_fraction * good_density(residual);
    return good / (good + (1.0 - inlier_fraction) * outliers);
  }

  /// The density of a residual, good or not, given that of outliers there.
  template <class Number>
  [[nodiscard]] Number density(const Number& residual, const Number& outliers) const {
    return inlier_fraction * good_density(residual) + (1.0 - inlier_fraction) * outliers;
  }

  /// What a good measurement counts in a fit: less the farther it is out on the tail.
  template <class Number>
  [[nodiscard]] Number tail_weight(const Number& residual) const {
    const Number z = residual / scale;
    return 1.0 / (1.0 + z * z / degrees_of_freedom);
  }
};

/// Estimates a mixture from signed residuals and the densities of outliers at their measurements, from `start`: in
/// turns the most probable share, of which the likelihood is a concave function, and the scale, by a step of
/// expectation-maximisation. Before anything is measured the share is taken for what one good measurement leaves
/// plausible: of twenty good ones the likelihood alone makes outliers of one or two. O(n) for each of at most 50 steps.
[[nodiscard]] outlier_mixture estimate_mixture(const std::vector<double>& residuals,
                                               const std::vector<double>& outliers, outlier_mixture start = {});

namespace detail {

/// Of an array that stays as it is.
template <class Values>
[[nodiscard]] auto upper_median_of(const Values& values) {
  std::vector<typename Values::Scalar> copy(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) copy[i] = values(i);
  return upper_median(copy);
}

}  // namespace detail

/// What is added to reflectance before its logarithm is taken, in sr^-1: a hundredth of the median measurement of a
/// channel, so that the darkest measurements, which are mostly noise, do not decide; at least 0.0001.
template <class Measurements>
[[nodiscard]] double logarithm_offset(const Measurements& measured) {
  return std::max(1e-4, 0.01 * static_cast<double>(detail::upper_median_of(measured)));
}

/// Outlier weights without a parameter: the probability that a sample is good, times its weight on the tail. A sample
/// is judged as a whole: what goes wrong in a measurement is its direction, not one of its colours. The probability is
/// that of the mean of its three logarithmic residuals, whose sign is kept: that is one number, which the densities of
/// the mixture are of. How far it is out on the tail is said by their root mean square, which sees colours, too.
struct automatic_weights {
  /// Weigh good samples by their location on the tail, too?
  bool down_weight_tail = true;
  /// If given, good residuals have another scale in each region of the samples (of which there must be as many as are
  /// weighed): a fit that is good elsewhere must not make outliers of a highlight that it misses.
  std::shared_ptr<const sample_regions> regions = {};
  thread_count threads = {};

  [[nodiscard]] channel_values weigh(const channel_values& measured, const channel_values& estimated) const;

  /// The share of good samples and the scale of their residuals.
  [[nodiscard]] outlier_mixture mixture(const channel_values& measured, const channel_values& estimated) const;

  /// `logarithm_offset` of each channel.
  [[nodiscard]] static Eigen::Array3f offsets(const channel_values& measured, thread_count threads = {});

 private:
  struct deviations {
    Eigen::ArrayXf residual;   // mean of the channels' residuals
    Eigen::ArrayXf distance;   // root mean square of them
    Eigen::ArrayXf logarithm;  // mean of the channels' logarithms
    Eigen::ArrayXd outliers;   // the density of outliers there
  };

  [[nodiscard]] deviations deviate(const channel_values& measured, const channel_values& estimated) const;

  /// Of one sample, under the mixture of its region.
  [[nodiscard]] float weigh(const outlier_mixture& mixture, const deviations& found, Eigen::Index sample) const;

  /// The scale of good samples' distances, where `mixture` has that of their residuals: at least that.
  [[nodiscard]] double scale_of_distances(const deviations& found, const outlier_mixture& mixture) const;

  /// The residual below which half of the good ones among some samples lie, if these are the ones with the least.
  [[nodiscard]] static double half_of_the_good(const Eigen::ArrayXf& residuals, std::span<const Eigen::Index> samples,
                                               double inlier_fraction);

  /// As many samples are good, and their scale is another one; above 1 it would tell nothing.
  [[nodiscard]] static outlier_mixture rescaled(const outlier_mixture& mixture, double ratio);

  /// Every so many values, at most 20,000: enough to know two parameters and a density to a percent.
  template <class Values>
  [[nodiscard]] static std::vector<double> subset(const Values& values) {
    const Eigen::Index step = (values.size() + 19'999) / 20'000;
    std::vector<double> chosen;
    for (Eigen::Index i = 0; i < values.size(); i += step) chosen.push_back(values[i]);
    return chosen;
  }

  [[nodiscard]] static outlier_mixture estimate_from(const deviations& found);
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/outlier_mixture.ipp>
#endif
