#pragma once
/// Tests whether a part reflects like a reference. Both are measured in a few directions, not necessarily the same. In
/// a shared direction, equal surfaces differ only by noise: a chi-square statistic (F if the noise was estimated). In
/// any other direction, the reference predicts the part, by the prior and its discrepancy: Rasmussen and Williams,
/// "Gaussian Processes for Machine Learning", 2006, Eq. 2.23-2.24. The covariance of the channels is estimated from the
/// reference, as `sample_process` estimates its scale. Error rates on measured materials: docs/results/conformity.md.

#include <gonio/core/rgb.hpp>
#include <gonio/core/turned_pair.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/reconstruction.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace gonio {

/// The error of a measured value, independent in each channel of each measurement.
struct measurement_noise {
  double relative = 0.0;  ///< standard deviation relative to the value: 0.02 is 2 %
  double dark = 0.0;      ///< standard deviation for zero reflectance, sr^-1
  /// Degrees of freedom of the estimate of `relative`; infinite if it is known.
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
};

struct conformity_options {
  measurement_noise part = {}, reference = {};
  /// The largest difference of a conforming part, relative to the value (0.05 is 5 %), for a logarithmic metric: one
  /// number, or one for each channel.
  std::vector<double> tolerance = {0.0};
  /// If set, the tolerance of directions whose half vector is within 5 degrees of the normal.
  std::optional<double> peak_tolerance = {};
  /// If above 0, a part in red, green and blue conforms if its colour differs in no direction by more than this CIELAB
  /// 1976 difference, linearised. The colours are reflectance factors under D65. The verdict then uses only
  /// `worst_p_value`, and no other tolerance is allowed.
  double delta_e = 0.0;
  /// Pairs of light and viewer are the same direction if, after a rotation about the normal or a swap of both, each
  /// differs by at most this angle, radians.
  double same_direction = 0.01 * std::numbers::pi / 180.0;
};

/// Compares one measurement of the part with the reference.
struct compared_direction {
  Eigen::Index number = 0;    ///< position of this direction among the part's located samples
  Eigen::Index measured = 0;  ///< number of the reference's samples in this direction; 0 if the reference is predicted
  // For each channel:
  Eigen::ArrayXd value;           ///< reflectance of the part, sr^-1
  Eigen::ArrayXd expected;        ///< reflectance of the reference, measured or predicted, sr^-1
  Eigen::ArrayXd difference;      ///< part minus reference, mapped: relative if the metric is a logarithm
  Eigen::ArrayXd deviation;       ///< the standard deviation of `difference` if part and reference are alike
  double delta_e = 0.0;           ///< CIELAB 1976 colour difference under D65; 0 unless there are three channels
  double p_value = 1.0;           ///< p-value of this direction alone
  double adjusted_p_value = 1.0;  ///< p_value adjusted for all directions together, by Holm (1979)
};

/// A p-value is the probability of a difference at least as large if the part is like the reference. `shift`,
/// `shift_p_value` and `total_p_value` use only directions in which both were measured, because predictions are less
/// certain. If there are none, they use all directions.
struct conformity {
  /// The p-value of the whole comparison: three times the smallest of `shift_p_value`, `total_p_value` and
  /// `worst_p_value` (Bonferroni), at most 1. With a Delta E tolerance, or for a single direction, it equals
  /// `worst_p_value`.
  double p_value = 1.0;
  double shift_p_value =
      1.0;  ///< p-value of a shift that is the same in all directions; one degree of freedom for each channel
  double total_p_value = 1.0;  ///< p-value of all differences; one degree of freedom for each direction and channel
  double worst_p_value = 1.0;  ///< p-value of the worst direction, adjusted for the number of directions
  Eigen::ArrayXd shift;        ///< best linear unbiased estimate of the shift of the mapped values in each channel
  std::vector<compared_direction> directions;  ///< one for each of the part's samples, in their order

  /// Returns true if the comparison shows no difference. `false_alarms` is the rate at which it would show one between
  /// parts that are alike.
  [[nodiscard]] bool conforms(double false_alarms = 0.01) const noexcept { return p_value >= false_alarms; }
  /// Returns the number of directions in which the reference has no measurement.
  [[nodiscard]] Eigen::Index predicted() const noexcept {
    return std::ranges::count(directions, Eigen::Index{0}, &compared_direction::measured);
  }
  /// Returns the position of the direction with the smallest p-value.
  [[nodiscard]] Eigen::Index worst() const noexcept {
    return std::ranges::min_element(directions, {}, &compared_direction::p_value) - directions.begin();
  }
};

namespace detail {

/// The n samples of a part, followed by the samples of a reference: N samples together.
struct conformity_samples {
  Eigen::Index parts = 0;
  std::vector<turned_pair> pairs;
  Eigen::MatrixXd mapped;      ///< mapped reflectance minus the prior's mean, N x channels
  Eigen::MatrixXd covariance;  ///< of the mapped reflectance of one channel, according to the model, N x N
  double independent = 0.0;    ///< the model's error variance that is independent in each direction
  Eigen::MatrixXd noise;       ///< variances of the measurements, N x channels
  Eigen::MatrixXd tolerance;   ///< tolerance of the part's mapped values, n x channels
  std::vector<Eigen::Matrix3d> lab_by_mapped;  ///< derivatives of CIELAB, for each of the part's samples; or empty
};

/// Compares samples. Does not set `value` and `expected` of the directions.
[[nodiscard]] conformity compare_samples(conformity_samples samples, const conformity_options& options);

/// Returns the minimum of (r - x)' M (r - x) over all x with |x_i| <= tolerance_i, for positive semidefinite M. Uses
/// coordinate descent until no x_i moves by more than 1e-9 of the largest tolerance.
[[nodiscard]] double least_within(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& residuals,
                                  const Eigen::VectorXd& tolerance);

/// Returns the minimum of (r - x)' M (r - x) over all x with |J x| <= length, for positive definite M and invertible J.
/// Finds the Lagrange multiplier by bisection.
[[nodiscard]] double least_within(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& residuals,
                                  const Eigen::Matrix3d& jacobian, double length);

void require_possible(const conformity_options& options, Eigen::Index channels);

/// Returns the tolerance of a channel at a location, relative to the reflectance.
[[nodiscard]] double tolerance_of(const conformity_options& options, Eigen::Index channel, const location& at);

/// Returns the CIELAB 1976 difference of two colours in sr^-1, seen as reflectance factors under D65.
[[nodiscard]] double delta_e_of(const rgb& one, const rgb& other);

/// Joins part and reference. Keeps a single channel if all channels are equal, as when one value was read into three
/// channels; otherwise keeps all.
[[nodiscard]] located_samples both_of(const located_samples& part, const located_samples& reference);

/// Returns 1 if all columns are equal, otherwise the number of columns.
[[nodiscard]] Eigen::Index distinct_channels(const Eigen::MatrixXd& values);

/// Returns pairs of light and viewer with these angles.
[[nodiscard]] std::vector<turned_pair> pairs_of(const std::vector<location>& locations);

/// Returns the positions of all pairs in the same direction as that at a position, ascending.
[[nodiscard]] std::vector<Eigen::Index> same_directions(const std::vector<turned_pair>& pairs, Eigen::Index position,
                                                        double limit);

/// Returns the standard deviation of a value's noise in the metric's domain.
template <error_metric Metric>
[[nodiscard]] double mapped_noise_of(const Metric& metric, double value, const location& at,
                                     const measurement_noise& noise) {
  const double centre = std::max(value, 0.0), reach = std::hypot(noise.relative * centre, noise.dark);
  return 0.5 * (metric.forward(centre + reach, at) - metric.forward(std::max(centre - reach, 0.0), at));
}

/// Returns `mapped_noise_of` the value, but at least half of the relative noise: near zero, where the map is flat,
/// small differences are no evidence.
template <error_metric Metric>
[[nodiscard]] double mapped_deviation(const Metric& metric, double value, const location& at,
                                      const measurement_noise& noise) {
  return std::max(mapped_noise_of(metric, value, at, noise), 0.5 * noise.relative);
}

/// Returns the derivatives of CIELAB under D65 by the mapped values of a colour in sr^-1.
template <error_metric Metric>
[[nodiscard]] Eigen::Matrix3d lab_by_mapped(const Metric& metric, const rgb& colour, const location& at) {
  constexpr double step = 1e-3;
  Eigen::Matrix3d slopes;
  for (Eigen::Index c = 0; c < 3; ++c) {
    const double mapped = metric.forward(std::max(colour[c], 0.0), at);
    rgb more = colour, less = colour;
    more[c] = metric.inverse(mapped + step, at);
    less[c] = metric.inverse(mapped - step, at);
    slopes.col(c) =
        ((to_unclipped_lab(std::numbers::pi * more) - to_unclipped_lab(std::numbers::pi * less)) / (2.0 * step))
            .matrix();
  }
  return slopes;
}

}  // namespace detail

/// Compares n samples of a part with r samples of a reference, in any number of channels c: colours, wavelengths, one
/// value. Where the reference has no measurement, the estimator's prior and model predict it from its other directions;
/// if both were measured in all directions, prior and model have no effect. The model's noise and grazing variance are
/// not used. If all channels are equal, they count as one.
///
/// If part and reference reflect alike (within the tolerance), have the stated noise, and were measured in the same
/// directions, `conforms(a)` is false with a probability of at most a. For predicted directions, this holds on average
/// over measured materials, but not for each material: docs/results/conformity.md. Noise shared by channels or
/// directions, such as a lamp's drift, is not modelled: allow for it by a tolerance. With a tolerance, each statistic
/// is its minimum over all allowed differences. Negative values count as zero; if noise causes them, state dark noise.
///
/// O((n + r)^2 k + r^3 + (n c)^3) for k components. Throws gonio::error for impossible options, for a part without
/// noise, if part and reference have different channels, and for more than 2,500 samples of the part, 6,000 of both, or
/// 7,500 values of the part: 2,100 directions of three channels take 2.3 GB.
///
/// ```cpp
/// const gonio::reconstruction estimator{prior};
/// const auto part = gonio::locate_samples(prior.cells(), gonio::io::read_samples("part.csv"));
/// const auto good = gonio::locate_samples(prior.cells(), gonio::io::read_samples("good.csv"));
/// const auto found = gonio::check_conformity(estimator, part, good, {.part = {0.02}, .reference = {0.02}});
/// if (!found.conforms(0.01)) std::printf("differs, p = %g\n", found.p_value);
/// ```
template <error_metric Metric>
[[nodiscard]] conformity check_conformity(const reconstruction<Metric>& estimator, const located_samples& part,
                                          const located_samples& reference, const conformity_options& options) {
  detail::require_possible(options, part.values.cols());
  const auto& metric = estimator.prior().metric();

  // Join part and reference. The noise variance of a sample is divided by the sample's weight.
  const located_samples both = detail::both_of(part, reference);
  if (options.delta_e > 0.0 && both.values.cols() != 3) refuse("a Delta E tolerance needs part and reference in RGB");
  discrepancy_model model = estimator.model();
  model.noise = 0.0;
  model.grazing_variance = 0.0;  // one variance for all errors, as in the calibration of p-values
  const sample_process process = reconstruction<Metric>{estimator.prior(), model}.process_of(both);
  detail::conformity_samples samples{.parts = part.size(),
                                     .pairs = detail::pairs_of(both.locations),
                                     .mapped = process.values(),
                                     .covariance = process.covariance(),
                                     .independent = model.error_variance,
                                     .noise = Eigen::MatrixXd(both.size(), both.values.cols()),
                                     .tolerance = Eigen::MatrixXd(part.size(), both.values.cols()),
                                     .lab_by_mapped = {}};
  for (Eigen::Index i = 0; i < both.size(); ++i) {
    const location& at = both.locations[i];
    const bool is_part = i < part.size();
    const double weight = is_part ? part.weights.row(i).mean() : reference.weights.row(i - part.size()).mean();
    for (Eigen::Index c = 0; c < both.values.cols(); ++c) {
      const double deviation =
          detail::mapped_deviation(metric, both.values(i, c), at, is_part ? options.part : options.reference);
      samples.noise(i, c) = deviation * deviation / weight;
      if (is_part) samples.tolerance(i, c) = std::log1p(detail::tolerance_of(options, c, at));
    }
    if (is_part && options.delta_e > 0.0 && both.values.cols() == 3)
      samples.lab_by_mapped.push_back(detail::lab_by_mapped(metric, both.values.row(i).transpose().array(), at));
  }
  conformity found = detail::compare_samples(std::move(samples), options);

  // Convert to sr^-1.
  for (compared_direction& each : found.directions) {
    const location& at = part.locations[each.number];
    each.value = both.values.row(each.number).transpose().array();
    each.expected = each.value;
    for (Eigen::Index c = 0; c < each.value.size(); ++c)
      each.expected[c] = reflectance_of(metric, metric.forward(each.value[c], at) - each.difference[c], at);
    if (each.value.size() == 3) each.delta_e = detail::delta_e_of(each.value, each.expected);
  }
  return found;
}

/// Estimates relative noise from repeated measurements in the same direction, pooled over channels and directions. The
/// degrees of freedom are 0 if no direction is repeated. Ignores values near zero. O(n^2). Throws gonio::error for more
/// than 5,000 samples.
template <error_metric Metric>
[[nodiscard]] measurement_noise noise_of_repeats(const Metric& metric, const located_samples& samples,
                                                 const conformity_options& options = {}) {
  constexpr Eigen::Index most_samples = 5000;
  if (samples.size() > most_samples)
    refuse({"noise can be estimated from repeats among at most ", most_samples, " samples, not ", samples.size(),
            ": give the noise instead"});
  const Eigen::Index channels = detail::distinct_channels(samples.values);
  const std::vector<turned_pair> pairs = detail::pairs_of(samples.locations);
  double squares = 0.0, freedom = 0.0;
  for (Eigen::Index i = 0; i < samples.size(); ++i) {
    const auto same = detail::same_directions(pairs, i, options.same_direction);
    // Count each direction once, at its first sample.
    if (same.front() != i || same.size() < 2) continue;
    const location& at = samples.locations[i];
    for (Eigen::Index c = 0; c < channels; ++c) {
      double mean = 0.0, value = 0.0;
      for (const Eigen::Index j : same) {
        mean += metric.forward(samples.values(j, c), at) / static_cast<double>(same.size());
        value += samples.values(j, c) / static_cast<double>(same.size());
      }
      // Divide by the effect of 1 % noise on the mapped value. Skip values near zero, whose noise is different.
      const double mapped = detail::mapped_noise_of(metric, value, at, {.relative = 0.01});
      if (!(mapped > 0.005)) continue;
      for (const Eigen::Index j : same)
        squares += std::pow(0.01 * (metric.forward(samples.values(j, c), at) - mean) / mapped, 2);
      freedom += static_cast<double>(same.size()) - 1.0;
    }
  }
  return {.relative = freedom > 0.0 ? std::sqrt(squares / freedom) : 0.0, .degrees_of_freedom = freedom};
}

/// Pools two estimates of the same relative noise, weighted by their degrees of freedom.
[[nodiscard]] measurement_noise pooled_noise(const measurement_noise& a, const measurement_noise& b);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/conformity/impl/conformity.ipp>
#endif
