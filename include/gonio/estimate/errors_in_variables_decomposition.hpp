#pragma once
/// Basis decomposition of samples whose directions have errors: light and viewer are each off by an angle in an unknown
/// direction.

#include <gonio/estimate/angular_error.hpp>
#include <gonio/estimate/estimator.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/sample_process.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// The reconstruction of Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Eq. 12, from samples whose light and viewer
/// may be anywhere on circles of `angle` radians around their directions.
///
/// The expected value of such a sample uses the mean of the prior's rows q over the circles. At an actual location x
/// the value deviates from the expected one by d = (q(x) - mean q) . c + o(x) - mean o, where c are the weights and o
/// is the mean material's value at x, mapped as if measured at the stated location. The variance v, the mean of d^2,
/// counts as an error of this sample: with m observations it adds m v to the penalty eta, so the sample has the weight
/// eta / (eta + m v). v is zero for a matte material and large on the flank of a highlight, so the fit is made twice.
/// First, v is averaged over the prior's observations, whose weights have C'C = I: m v is the mean of |q(x) - mean q|^2
/// + m (o(x) - mean o)^2. Then v is averaged over the channels of the first fit.
///
/// If this fit agrees with a fit that trusts the directions, the angular error does not matter:
/// ```cpp
/// const auto paint = gonio::errors_in_variables_decomposition{prior, 40.0, gonio::radians(0.5)}.fit(samples);
/// const auto trusting = gonio::decomposition{prior, gonio::tikhonov{40.0}}.fit(samples);
/// ```
template <error_metric Metric>
class errors_in_variables_decomposition {
 public:
  /// Throws gonio::error unless eta is positive and the angle is from 0 to 45 degrees.
  errors_in_variables_decomposition(pca<Metric> prior, double eta, double angle, thread_count threads = {})
      : prior_(std::move(prior)), solver_(eta), angle_(angle), threads_(threads) {
    if (!(angle >= 0.0 && angle <= std::numbers::pi / 4.0))
      refuse("the angular error of samples must be from 0 to 45 degrees, not " + std::to_string(degrees(angle)));
  }

  /// Fits samples. O(16 n k) for n samples and k components, plus the solver's cost. Throws gonio::error for unusable
  /// samples.
  [[nodiscard]] fitted_brdf<pca<Metric>> fit(const sample_set& samples) const {
    const located_samples measured = locate_samples(prior_.cells(), samples, threads_);
    const system equations = average(measured);
    const solution first = solve(equations, measured.weights, equations.sample_noise_penalty);
    return {prior_, solve(equations, measured.weights, sample_noise_penalties(measured, equations, first.weights)),
            measured.kinds};
  }

 private:
  static constexpr Eigen::Index sides = 4;

  /// The equations of n samples, averaged over their circles.
  struct system {
    row_matrix rows;                       ///< the mean row of each sample, n x k
    Eigen::VectorXd offsets;               ///< the mean material's mapped value, n
    Eigen::MatrixXd right;                 ///< mapped values minus the offsets, n x channels
    Eigen::VectorXd sample_noise_penalty;  ///< m v over the prior's observations, n
  };

  /// The prior's rows and mapped means at 4 x 4 pairs of directions on a sample's circles.
  struct displaced {
    std::array<Eigen::RowVectorXd, sides * sides> rows;
    std::array<double, sides * sides> offsets;
  };

  [[nodiscard]] displaced around(const location& meant) const {
    const direction_pair pair = to_directions(meant.angles);
    displaced all;
    for (Eigen::Index number = 0; number < std::ssize(all.rows); ++number) {
      const direction wi = turned_above_horizon(pair.wi, angle_, side(number / sides)),
                      wo = turned_above_horizon(pair.wo, angle_, side(number % sides));
      const location there = locate(prior_.cells(), to_half_difference(wi, wo));
      all.rows[number] = row_at(prior_, there);
      const double reflectance = prior_.metric().inverse(offset_at(prior_, there), there);
      all.offsets[number] = prior_.metric().forward(reflectance, meant);
    }
    return all;
  }

  template <class Use>
  void for_each_sample(const located_samples& measured, Use&& use) const {
    for_each_index(
        measured.size(), 16, [&](Eigen::Index i) { use(i, measured.locations[i], around(measured.locations[i])); },
        threads_);
  }

  [[nodiscard]] system average(const located_samples& measured) const {
    const Eigen::Index n = std::ssize(measured.locations), k = prior_.size();
    const double m = prior_.observations();
    system means{row_matrix::Zero(n, k), Eigen::VectorXd::Zero(n), Eigen::MatrixXd(n, measured.values.cols()),
                 Eigen::VectorXd::Zero(n)};
    for_each_sample(measured, [&](Eigen::Index i, const location& meant, const displaced& seen) {
      constexpr double share = 1.0 / static_cast<double>(sides * sides);
      for (Eigen::Index number = 0; number < std::ssize(seen.rows); ++number) {
        means.rows.row(i) += share * seen.rows[number];
        means.offsets[i] += share * seen.offsets[number];
      }
      for (Eigen::Index number = 0; number < std::ssize(seen.rows); ++number)
        means.sample_noise_penalty[i] += share * ((seen.rows[number] - means.rows.row(i)).squaredNorm() +
                                                  m * square(seen.offsets[number] - means.offsets[i]));
      for (Eigen::Index c = 0; c < means.right.cols(); ++c)
        means.right(i, c) = prior_.metric().forward(measured.values(i, c), meant) - means.offsets[i];
    });
    return means;
  }

  /// Returns the penalty m v of each sample for a material with the given weights, with v averaged over the channels.
  [[nodiscard]] Eigen::VectorXd sample_noise_penalties(const located_samples& measured, const system& means,
                                                       const Eigen::MatrixXd& weights) const {
    const Eigen::Index channels = weights.cols();
    Eigen::VectorXd etas = Eigen::VectorXd::Zero(means.offsets.size());
    for_each_sample(measured, [&](Eigen::Index i, const location&, const displaced& seen) {
      for (Eigen::Index number = 0; number < std::ssize(seen.rows); ++number) {
        const Eigen::RowVectorXd change = seen.rows[number] - means.rows.row(i);
        for (Eigen::Index c = 0; c < channels; ++c)
          etas[i] += square(change.dot(weights.col(c)) + seen.offsets[number] - means.offsets[i]) /
                     static_cast<double>(channels);
      }
      etas[i] *= prior_.observations() / static_cast<double>(seen.rows.size());
    });
    return etas;
  }

  /// `sample_weights` has the layout of `located_samples::weights`.
  [[nodiscard]] solution solve(const system& equations, const Eigen::MatrixXd& sample_weights,
                               const Eigen::VectorXd& sample_noise_penalty) const {
    const double eta = solver_.eta();
    const Eigen::ArrayXd share = eta / (eta + sample_noise_penalty.array());
    const Eigen::Index systems = sample_weights.cols(), together = equations.right.cols() / systems;
    std::vector<solution> found;
    for (Eigen::Index column = 0; column < systems; ++column)
      found.push_back(solver_.solve(least_squares_problem(
          equations.rows, Eigen::MatrixXd(equations.right.middleCols(column * together, together)),
          Eigen::VectorXd(sample_weights.col(column).array() * share))));
    return concatenate_columns(found);
  }

  /// Returns the angle of one of the equidistant points on a circle, in radians.
  [[nodiscard]] static double side(Eigen::Index quarter) noexcept {
    return 2.0 * std::numbers::pi * static_cast<double>(quarter) / static_cast<double>(sides);
  }
  [[nodiscard]] static double square(double x) noexcept { return x * x; }

  pca<Metric> prior_;
  tikhonov solver_;
  double angle_;
  thread_count threads_;
};

static_assert(estimator<errors_in_variables_decomposition<log_relative>>);

/// Returns samples weighted for a `reconstruction` by this prior if light and viewer are each off by `angle` radians.
/// Each weight is multiplied by e / (e + v), where e is the model's error variance and v the variance of the mapped
/// value due to these rotations. O(n k) for n samples and k components.
template <error_metric Metric>
[[nodiscard]] sample_set weighted_by_angular_error(const sample_set& samples, const pca<Metric>& prior,
                                                   const discrepancy_model& model, double angle) {
  sample_set weighted(samples.channels());
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    const double error = error_variance_at(model, samples.directions(i).angles()),
                 angular_variance =
                     angular_error_penalty(prior, samples.directions(i).pair(), angle) / prior.observations();
    weighted.add(samples.directions(i), samples.values(i),
                 rgb(samples.weight(i).of_each() * error / (error + angular_variance)), samples.aperture(i));
  }
  return weighted;
}

}  // namespace gonio
