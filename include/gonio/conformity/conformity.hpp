#pragma once
/// Does a part reflect like a reference? Both are measured in a few directions, the same or others.
/// In a direction that both have, the mapped values differ by their noise alone: a chi-square statistic (F if the noise
/// was estimated). In any other direction the reference predicts the part, by the prior and its discrepancy: Rasmussen
/// and Williams, "Gaussian Processes for Machine Learning", 2006, Eq. 2.23-2.24. The covariance of its channels is
/// learned from the reference, as `sample_process` learns its scale.
/// How often it is wrong on measured materials: docs/results/conformity.md.

#include <gonio/core/rgb.hpp>
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
  double dark = 0.0;      ///< standard deviation where nothing is reflected, sr^-1
  /// Of the estimate of `relative`; infinite if it is known.
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
};

struct conformity_options {
  measurement_noise part = {}, reference = {};
  /// A part conforms if none of its values is off by more than this, relative to it: one number, or one a channel.
  std::vector<double> tolerance = {0.0};
  /// The same near the mirror direction, where the half vector is within 5 degrees of the normal, if that differs.
  std::optional<double> peak_tolerance = {};
  /// If above 0, a part of three colours conforms if no direction's colour is off by more than this CIELAB 1976
  /// difference, linearised. Colours are those of reflectance factors under D65. Then the verdict rests on
  /// `worst_p_value` alone, and no other tolerance may be given.
  double delta_e = 0.0;
  /// Half and difference angles that differ by no more than this are one direction, radians.
  double same_direction = 0.01 * std::numbers::pi / 180.0;
};

/// What the reference says of one measurement of the part.
struct compared_direction {
  Eigen::Index number = 0;    ///< its position among the part's located samples
  Eigen::Index measured = 0;  ///< so many samples of the reference have the same direction; 0: it is predicted
  // For each channel:
  Eigen::ArrayXd value;           ///< of the part, sr^-1
  Eigen::ArrayXd expected;        ///< of the reference, sr^-1
  Eigen::ArrayXd difference;      ///< of the mapped values: relative where the metric is a logarithm
  Eigen::ArrayXd deviation;       ///< the standard deviation of `difference` if part and reference are alike
  double delta_e = 0.0;           ///< of the colours, CIELAB 1976 under D65; 0 unless there are three
  double p_value = 1.0;           ///< of this direction alone
  double adjusted_p_value = 1.0;  ///< the same by Holm (1979), for all directions at once
};

/// A p-value is the probability of a difference at least as large if the part is like the reference. `shift` and
/// `total` are of the directions that both have, or of all if there is none: where the reference predicts it is less
/// sure.
struct conformity {
  double p_value = 1.0;        ///< as a whole: three times the least of the next three (Bonferroni), at most 1; with
                               ///< `conformity_options::delta_e` the last of them
  double shift_p_value = 1.0;  ///< of one shift of each channel, the same in all directions, a degree of freedom each
  double total_p_value = 1.0;  ///< of all differences, a degree of freedom for each channel of each direction
  double worst_p_value = 1.0;  ///< of the worst direction, times their number
  Eigen::ArrayXd shift;        ///< of the mapped values of each channel; its best linear unbiased estimate
  std::vector<compared_direction> directions;  ///< of the part, in its order

  /// Is there no evidence of a difference, with so many false alarms among parts that are alike?
  [[nodiscard]] bool conforms(double false_alarms = 0.01) const noexcept { return p_value >= false_alarms; }
  /// Of how many directions the reference has no measurement.
  [[nodiscard]] Eigen::Index predicted() const noexcept {
    return std::ranges::count(directions, Eigen::Index{0}, &compared_direction::measured);
  }
  /// The position of the least p-value among the directions.
  [[nodiscard]] Eigen::Index worst() const noexcept {
    return std::ranges::min_element(directions, {}, &compared_direction::p_value) - directions.begin();
  }
};

namespace detail {

/// The samples of a part and, after them, of a reference.
struct conformity_samples {
  Eigen::Index parts = 0;
  std::vector<half_difference> angles;
  Eigen::MatrixXd mapped;                      ///< less the prior's mean, N x channels
  Eigen::MatrixXd covariance;                  ///< of the mapped reflectance by the model, for one channel, N x N
  double independent = 0.0;                    ///< of its diagonal: what is independent in each direction
  Eigen::MatrixXd noise;                       ///< variances of the measurements, N x channels
  Eigen::MatrixXd tolerance;                   ///< of the part's mapped values, parts x channels
  std::vector<Eigen::Matrix3d> lab_by_mapped;  ///< by which CIELAB changes with them, of each part; or empty
};

/// Without `value` and `expected` of the directions.
[[nodiscard]] conformity compare_samples(conformity_samples samples, const conformity_options& options);

/// The least (r - x)' M (r - x) of all x that are off zero by no more than the tolerance, M positive semidefinite:
/// coordinate descent, which ends where no x moves by a relative 1e-9 any more.
[[nodiscard]] double least_within(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& residuals,
                                  const Eigen::VectorXd& tolerance);

/// The least (r - x)' M (r - x) of all x with |J x| <= length, M positive definite, J regular: a Lagrange multiplier
/// found by bisection.
[[nodiscard]] double least_within(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& residuals,
                                  const Eigen::Matrix3d& jacobian, double length);

void require_possible(const conformity_options& options, Eigen::Index channels);

/// The tolerance of a channel at a location, relative to a value.
[[nodiscard]] double tolerance_of(const conformity_options& options, Eigen::Index channel, const location& at);

/// CIELAB 1976 under D65 of two colours, sr^-1.
[[nodiscard]] double delta_e_of(const rgb& one, const rgb& other);

/// Of all channels; of one if the channels are the same, as those of one reading are that stands for three.
[[nodiscard]] located_samples both_of(const located_samples& part, const located_samples& reference);

/// How many of some columns count: one if they are all the same.
[[nodiscard]] Eigen::Index distinct_channels(const Eigen::MatrixXd& values);

/// The positions of measurements in the same direction as a place.
[[nodiscard]] std::vector<Eigen::Index> same_directions(const std::vector<location>& locations,
                                                        const half_difference& place, double limit);

/// The standard deviation of a value's noise, mapped.
template <error_metric Metric>
[[nodiscard]] double mapped_noise_of(const Metric& metric, double value, const location& at,
                                     const measurement_noise& noise) {
  const double centre = std::max(value, 0.0), reach = std::hypot(noise.relative * centre, noise.dark);
  return 0.5 * (metric.forward(centre + reach, at) - metric.forward(std::max(centre - reach, 0.0), at));
}

/// The same; but where the map flattens, near zero, at least half of the relative noise: differences that are invisible
/// there are no evidence.
template <error_metric Metric>
[[nodiscard]] double mapped_deviation(const Metric& metric, double value, const location& at,
                                      const measurement_noise& noise) {
  return std::max(mapped_noise_of(metric, value, at, noise), 0.5 * noise.relative);
}

/// By how much CIELAB under D65 changes with the mapped values of a colour in sr^-1.
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

/// Compares n samples of a part with r of a reference, in any number of channels c: colours, wavelengths, one value.
/// The estimator's prior and model say what of one direction is known from others; where all directions are shared they
/// do not matter. Its noise is not used. Channels that are the same in all samples are one.
///
/// If part and reference reflect alike (within the tolerance) and have the stated noise, `conforms(a)` is false with a
/// probability of at most a where all directions are shared. Where they are predicted, that was found of the mean of
/// measured materials, not of each: docs/results/conformity.md. Noise that channels or directions have in common, as of
/// a lamp that drifts, is not counted: a tolerance allows for it. With a tolerance each statistic is the least that any
/// allowed difference leaves. Negative values count as zero; where noise makes them, only dark noise explains them.
///
/// O((n + r)^2 k + r^3 + (n c)^3). Throws gonio::error for impossible options, for a part without noise, for other
/// channels of the part than of the reference, and for more than 2,500 samples of the part, 6,000 of both, or 7,500
/// values of the part: 2,100 directions of three channels take 2.3 GB.
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

  // Put the two together. The weights of samples divide the variances of their noise.
  const located_samples both = detail::both_of(part, reference);
  if (options.delta_e > 0.0 && both.values.cols() != 3)
    refuse("a tolerance of Delta E needs red, green and blue, which part and reference have not");
  discrepancy_model model = estimator.model();
  model.noise = 0.0;
  model.grazing_variance = 0.0;  // one variance of all errors, as p-values were calibrated with
  const sample_process process = reconstruction<Metric>{estimator.prior(), model}.process_of(both);
  detail::conformity_samples samples{.parts = part.size(),
                                     .angles = both.angles(),
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

  // Say it in sr^-1.
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

/// The noise of samples that were measured more than once in a direction, from how they differ there: pooled over
/// channels and directions, its degrees of freedom 0 if there is no such direction. Values near zero are left out.
/// O(n^2). Throws gonio::error for more than 5,000 samples.
template <error_metric Metric>
[[nodiscard]] measurement_noise noise_of_repeats(const Metric& metric, const located_samples& samples,
                                                 const conformity_options& options = {}) {
  constexpr Eigen::Index most_samples = 5000;
  if (samples.size() > most_samples)
    refuse({"noise is told by repeats of at most ", most_samples, " samples, not of ", samples.size()});
  const Eigen::Index channels = detail::distinct_channels(samples.values);
  double squares = 0.0, freedom = 0.0;
  for (Eigen::Index i = 0; i < samples.size(); ++i) {
    const auto same = detail::same_directions(samples.locations, samples.locations[i].angles, options.same_direction);
    // Each direction once, by its first sample.
    if (same.front() != i || same.size() < 2) continue;
    const location& at = samples.locations[i];
    for (Eigen::Index c = 0; c < channels; ++c) {
      double mean = 0.0, value = 0.0;
      for (const Eigen::Index j : same) {
        mean += metric.forward(samples.values(j, c), at) / static_cast<double>(same.size());
        value += samples.values(j, c) / static_cast<double>(same.size());
      }
      // In units of what noise of 1 % becomes there. Values near zero, whose noise is another, say nothing of it.
      const double mapped = detail::mapped_noise_of(metric, value, at, {.relative = 0.01});
      if (!(mapped > 0.005)) continue;
      for (const Eigen::Index j : same)
        squares += std::pow(0.01 * (metric.forward(samples.values(j, c), at) - mean) / mapped, 2);
      freedom += static_cast<double>(same.size()) - 1.0;
    }
  }
  return {.relative = freedom > 0.0 ? std::sqrt(squares / freedom) : 0.0, .degrees_of_freedom = freedom};
}

/// Two estimates of the same noise as one, each with as much weight as it has degrees of freedom.
[[nodiscard]] measurement_noise pooled_noise(const measurement_noise& a, const measurement_noise& b);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/conformity/impl/conformity.ipp>
#endif
