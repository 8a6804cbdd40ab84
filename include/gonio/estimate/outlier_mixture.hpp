#pragma once
/// Measurements as a mixture of inliers, which scatter about an estimate, and outliers, which follow a smoothed density
/// of all measured values. Noell, Koehler and Stricker 2014, section 2.3, choose gamma by hand ("depending on the
/// dynamic range and the outlier ratio"). Here expectation-maximisation (Dempster, Laird and Rubin 1977,
/// doi:10.1111/j.2517-6161.1977.tb01600.x) estimates it from the residuals. Inliers' residuals follow Student's t
/// (Lange, Little and Taylor 1989, doi:10.1080/01621459.1989.10478852).

#include <gonio/core/parallel.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/sample_regions.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace gonio {

/// The density of outliers: the density of the measurements' logarithms over their range, smoothed, and flattened by a
/// square root. The square root is a compromise. Without it, the density would explain all measurements as outliers.
/// With a constant density, a genuine highlight would be as likely an outlier as any other value.
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

/// A distribution of measurements. The residuals of inliers are `scale` times a variable of Student's t with 4 degrees
/// of freedom, whose tails allow for a fit that is wrong somewhere. All other samples are outliers.
struct outlier_mixture {
  double inlier_fraction = 0.8;
  double scale = 0.3;  ///< of the residuals of inliers, which are natural logarithms

  static constexpr double degrees_of_freedom = 4.0;
  /// The smallest `scale`: one percent, because no basis is more accurate. A scale of zero would make every decision
  /// certain.
  static constexpr double smallest_scale = 0.01;

  /// Returns the density of an inlier's residual.
  [[nodiscard]] double inlier_density(double residual) const noexcept { return density_on_tail(tail_weight(residual)); }
  /// Returns the density of an inlier's residual, given the residual's tail weight.
  [[nodiscard]] double density_on_tail(double tail) const noexcept {
    return (0.375 / scale) * (tail * tail * std::sqrt(tail));
  }

  /// Returns the probability that a measurement is an inlier, given its residual and the density of outliers at the
  /// measurement's logarithm.
  [[nodiscard]] double probability(double residual, double outliers) const noexcept {
    const double inlier = inlier_fraction * inlier_density(residual);
    return inlier / (inlier + (1.0 - inlier_fraction) * outliers);
  }

  /// Returns the weight of an inlier in a fit, which falls with the size of its residual.
  [[nodiscard]] double tail_weight(double residual) const noexcept {
    const double z = residual / scale;
    return 1.0 / (1.0 + z * z / degrees_of_freedom);
  }
};

/// Estimates a mixture from signed residuals and the density of outliers at each measurement, beginning with `start`.
/// Alternates between the most probable inlier fraction, whose log-likelihood is concave, and a step of
/// expectation-maximisation for the scale. The prior of the fraction is worth one inlier; without it, one or two of
/// twenty inliers become outliers. O(n) for each of at most 50 steps.
[[nodiscard]] outlier_mixture estimate_mixture(const std::vector<double>& residuals,
                                               const std::vector<double>& outliers, outlier_mixture start = {});

/// Returns the number in sr^-1 that is added to reflectance before the logarithm: a hundredth of the median measurement
/// of a channel, at least 0.0001. Without this offset, the darkest measurements, which are mostly noise, would have the
/// largest residuals.
[[nodiscard]] double logarithm_offset(std::vector<double> measured);

/// Outlier weights without a parameter: the probability that a sample is an inlier, times its `tail_weight`. All
/// channels of a sample get the same weight, because an error usually affects the whole sample. The probability uses
/// the signed mean of the three logarithmic residuals, because the densities of the mixture are those of one number.
/// The tail weight uses the root mean square of these residuals, which also contains differences of colour.
struct automatic_weights {
  /// Whether to multiply by the tail weight.
  bool down_weight_tail = true;
  /// If given, inliers' residuals have a different scale in each region, so that a highlight that the fit misses does
  /// not become outliers only because the fit is good elsewhere. The regions must be those of the samples that are
  /// weighed.
  std::shared_ptr<const sample_regions> regions = {};
  thread_count threads = {};

  [[nodiscard]] channel_values weigh(const channel_values& measured, const channel_values& estimated) const;

  /// Returns the inlier fraction and the scale of the inliers' residuals.
  [[nodiscard]] outlier_mixture mixture(const channel_values& measured, const channel_values& estimated) const;

  /// Returns `logarithm_offset` of each channel.
  [[nodiscard]] static std::array<float, 3> offsets(const channel_values& measured);

 private:
  struct deviations {
    std::vector<float> residual;   // mean of the channels' residuals
    std::vector<float> distance;   // root mean square of the channels' residuals
    std::vector<float> logarithm;  // mean of the channels' logarithms
    std::vector<double> outliers;  // density of outliers at `logarithm`
  };

  [[nodiscard]] deviations deviate(const channel_values& measured, const channel_values& estimated) const;

  /// Returns the weight of one sample, under the mixture of its region.
  [[nodiscard]] float weigh(const outlier_mixture& mixture, const deviations& found, Eigen::Index sample) const;

  /// Returns the scale of inliers' distances (root mean squares), which is at least the scale of their residuals in
  /// `mixture`.
  [[nodiscard]] double scale_of_distances(const deviations& found, const outlier_mixture& mixture) const;

  /// Returns the median residual of the inliers among some samples. Takes the fraction `inlier_fraction` of the samples
  /// with the smallest residuals as inliers.
  [[nodiscard]] static double median_of_inliers(const std::vector<float>& residuals,
                                                std::span<const Eigen::Index> samples, double inlier_fraction);

  /// Returns the mixture with its scale times `ratio`, at most 1: a larger scale would carry no information.
  [[nodiscard]] static outlier_mixture rescaled(const outlier_mixture& mixture, double ratio);

  /// Returns at most 20,000 values, evenly spaced: enough to estimate two parameters and a density to a percent.
  template <class Values>
  [[nodiscard]] static std::vector<double> subset(const Values& values) {
    const std::size_t step = (values.size() + 19'999) / 20'000;
    std::vector<double> chosen;
    for (std::size_t i = 0; i < values.size(); i += step) chosen.push_back(values[i]);
    return chosen;
  }

  [[nodiscard]] static outlier_mixture estimate_from(const deviations& found);
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/outlier_mixture.ipp>
#endif
