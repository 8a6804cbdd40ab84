#pragma once
/// Measurements as a mixture of inliers, which scatter about an estimate, and of outliers. Outliers follow a smoothed
/// density of all measured values. What Noell, Koehler and Stricker 2014, section 2.3, choose by hand (gamma,
/// "depending on the dynamic range and the outlier ratio") is estimated here from the residuals by expectation and
/// maximisation (Dempster, Laird and Rubin 1977, doi:10.1111/j.2517-6161.1977.tb01600.x); inliers' residuals follow
/// Student's t (Lange, Little and Taylor 1989, doi:10.1080/01621459.1989.10478852).

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

/// Good residuals are `scale` times a variable of Student's t with 4 degrees of freedom, whose tails let the fit be
/// wrong somewhere; all others are outliers.
struct outlier_mixture {
  double inlier_fraction = 0.8;
  double scale = 0.3;  ///< of the logarithm of reflectance

  static constexpr double degrees_of_freedom = 4.0;
  /// A percent: no basis is better, and a scale of zero would be certain of everything.
  static constexpr double smallest_scale = 0.01;

  /// The density of a good residual.
  [[nodiscard]] double good_density(double residual) const noexcept { return density_on_tail(tail_weight(residual)); }
  /// The same, given the residual's tail weight.
  [[nodiscard]] double density_on_tail(double tail) const noexcept {
    return (0.375 / scale) * (tail * tail * std::sqrt(tail));
  }

  /// The probability that a measurement is good, given its residual and the density of outliers there.
  [[nodiscard]] double probability(double residual, double outliers) const noexcept {
    const double good = inlier_fraction * good_density(residual);
    return good / (good + (1.0 - inlier_fraction) * outliers);
  }

  /// What a good measurement counts in a fit: less the farther it is out on the tail.
  [[nodiscard]] double tail_weight(double residual) const noexcept {
    const double z = residual / scale;
    return 1.0 / (1.0 + z * z / degrees_of_freedom);
  }
};

/// Estimates a mixture from signed residuals and the densities of outliers at their measurements, from `start`: in
/// turns the most probable share, of which the likelihood is a concave function, and the scale, by a step of
/// expectation-maximisation. Before anything is measured the share is taken for what one good measurement leaves
/// plausible: of twenty good ones the likelihood alone makes outliers of one or two. O(n) for each of at most 50 steps.
[[nodiscard]] outlier_mixture estimate_mixture(const std::vector<double>& residuals,
                                               const std::vector<double>& outliers, outlier_mixture start = {});

/// What is added to reflectance before its logarithm is taken, in sr^-1: a hundredth of the median measurement of a
/// channel, so that the darkest measurements, which are mostly noise, do not decide; at least 0.0001.
[[nodiscard]] double logarithm_offset(std::vector<double> measured);

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
  [[nodiscard]] static std::array<float, 3> offsets(const channel_values& measured);

 private:
  struct deviations {
    std::vector<float> residual;   // mean of the channels' residuals
    std::vector<float> distance;   // root mean square of them
    std::vector<float> logarithm;  // mean of the channels' logarithms
    std::vector<double> outliers;  // the density of outliers there
  };

  [[nodiscard]] deviations deviate(const channel_values& measured, const channel_values& estimated) const;

  /// Of one sample, under the mixture of its region.
  [[nodiscard]] float weigh(const outlier_mixture& mixture, const deviations& found, Eigen::Index sample) const;

  /// The scale of good samples' distances, where `mixture` has that of their residuals: at least that.
  [[nodiscard]] double scale_of_distances(const deviations& found, const outlier_mixture& mixture) const;

  /// The residual below which half of the good ones among some samples lie, if these are the ones with the least.
  [[nodiscard]] static double half_of_the_good(const std::vector<float>& residuals,
                                               std::span<const Eigen::Index> samples, double inlier_fraction);

  /// As many samples are good, and their scale is another one; above 1 it would tell nothing.
  [[nodiscard]] static outlier_mixture rescaled(const outlier_mixture& mixture, double ratio);

  /// Every so many values, at most 20,000: enough to know two parameters and a density to a percent.
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
