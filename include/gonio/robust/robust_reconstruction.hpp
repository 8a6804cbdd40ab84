#pragma once
/// Reconstructs a BRDF by correction functions from measurements of unknown quality, without parameters to choose.
/// Extends Noell, Koehler and Stricker 2014 by a start that resists outliers and by outlier weights without a
/// parameter.

#include <gonio/core/random.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/robust/correction_iteration.hpp>
#include <gonio/robust/nearest_material.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace gonio {

namespace detail {

/// Combinations of materials fitted repeatedly to the same samples with different weights.
template <error_metric Metric>
class reweighted_combination {
 public:
  reweighted_combination(measured<Metric> materials, const located_samples& samples, thread_count threads);

  /// Returns non-negative weights of the materials, k x 3.
  [[nodiscard]] solution solve(const channel_values& inlier_weights) const;
  /// Returns weights that fit these samples and, with inlier weights of 1, the samples of `others`.
  [[nodiscard]] solution solve(const channel_values& inlier_weights, const reweighted_combination& others) const;

  /// Returns the combination's reflectance at the samples.
  [[nodiscard]] channel_values values(const solution& found) const;

  /// Returns the factors that convert squared errors of mapped reflectance to squared relative errors. At an estimate,
  /// the factor is the squared ratio of two slopes: that of ln(rho + offset) and that of the metric.
  [[nodiscard]] channel_values relative(const channel_values& estimates, const std::array<float, 3>& offsets) const;

 private:
  [[nodiscard]] normal_equations equations(Eigen::Index channel, const channel_values& inlier_weights) const;
  [[nodiscard]] solution combine(const std::array<normal_equations, 3>& equations) const;

  measured<Metric> materials_;
  sampled_functions<measured<Metric>> functions_;
  std::vector<location> locations_;
  channel_values confidence_;
  channel_values mapped_;
};

}  // namespace detail

/// Settings of the start of `robust_reconstruction`. The defaults were chosen on the ten test materials of Nielsen et
/// al. 2015 (doi:10.1145/2816795.2818085) and fifteen difficult ones (docs/results/robust-estimation.md).
struct robust_start {
  /// The largest number of samples for the start, chosen at random.
  Eigen::Index samples = 20'000;
  /// The largest number of samples for the final iteration; more do not improve the estimate of a hundred unknowns.
  Eigen::Index most_samples = 50'000;
  int combinations = 5;  ///< fits of the combination of materials
  int corrections = 4;   ///< steps of correction after these fits
  /// The nearest material's values over all cells are fitted together with the samples. Together they weigh as much as
  /// this number of samples. They determine the result where nothing was measured. Otherwise, without samples in the
  /// highlight, a combination that fits all samples may have any highlight.
  double expectation = 1.0;
  /// Rounds of the final iteration that use the inlier weights of the start.
  int initial_weight_rounds = 3;
  std::uint64_t seed = 0;
};

/// The final iteration of `robust_reconstruction`, one round at a time, like `correction_run`.
template <error_metric Metric>
class robust_run {
 public:
  using run_type = correction_run<fitted_brdf<gonio::measured<Metric>>>;
  using result_type = corrected_brdf<fitted_brdf<gonio::measured<Metric>>>;

  /// The first `initial_weight_rounds` rounds use `inlier_weights`, the following ones the weights of `run`.
  robust_run(run_type run, channel_values inlier_weights, int initial_weight_rounds);

  correction_round step();
  [[nodiscard]] bool converged() const noexcept { return run_.converged(); }

  [[nodiscard]] const channel_values& measured() const noexcept { return run_.measured(); }
  [[nodiscard]] channel_values estimated() const;
  [[nodiscard]] const std::vector<correction_round>& history() const noexcept { return run_.history(); }
  [[nodiscard]] result_type result() const;

 private:
  run_type run_;
  channel_values inlier_weights_;
  int initial_weight_rounds_;
};

/// Fits samples with any share of outliers, in these steps:
/// 1. Find the nearest material (`nearest_material`) from at most 20,000 of the samples.
/// 2. Combine materials by relative errors five times, then correct the combination four times, with new outlier
///    weights each time. The result is rough, but identifies the inliers.
/// 3. Combine materials again in their own metric, from the inliers; where there are no inliers, follow the nearest
///    material.
/// 4. Correct this combination with more samples: three rounds with the inlier weights of step 2, then with new ones.
///
/// Outliers are identified separately in each region of the samples. Otherwise, if a fit misses a highlight but is good
/// elsewhere, it would take the highlight for outliers and never recover.
///
/// No parameter must be adapted to the data: see `automatic_weights`.
///
/// ```cpp
/// const gonio::measured materials{gonio::expand(prior), gonio::log{}};
/// const auto paint = gonio::robust_reconstruction{materials}.fit(samples);
/// ```
template <error_metric Metric>
class robust_reconstruction {
 public:
  using initial_type = fitted_brdf<measured<Metric>>;
  using run_type = typename robust_run<Metric>::run_type;

  explicit robust_reconstruction(measured<Metric> materials, thread_count threads = {});

  /// Takes existing corrections, which must be over the same cells (else gonio::error).
  robust_reconstruction(measured<Metric> materials, correction corrections, const correction_limits& limits = {},
                        const robust_start& start = {}, thread_count threads = {});

  /// Makes steps 1 to 3 and returns a run that makes step 4. Takes samples, or a table whose cells are samples. Throws
  /// gonio::error for unusable samples.
  template <class Samples>
  [[nodiscard]] robust_run<Metric> initialise(const Samples& samples) const {
    return initialise_located(in_colours(locate_samples(corrections_.cells(), samples, threads_)));
  }

  /// Makes all steps. Throws gonio::error for unusable samples.
  template <class Samples>
  [[nodiscard]] corrected_brdf<initial_type> fit(const Samples& samples) const {
    robust_run run = initialise(samples);
    while (!run.converged()) run.step();
    return run.result();
  }

 private:
  struct initial_state {
    initial_type initial;
    run_type guide;  // the first rounds use its inlier weights
  };

  [[nodiscard]] robust_run<Metric> initialise_located(const located_samples& all) const;
  [[nodiscard]] located_samples some_of(const located_samples& samples, Eigen::Index count) const;
  /// Makes steps 1 to 3.
  [[nodiscard]] initial_state initial_state_of(const located_samples& some) const;
  /// Returns the chosen material's values at up to 1,000 cells all over the grid, as samples.
  [[nodiscard]] located_samples expectation(const nearest_material<Metric>& nearest,
                                            const std::array<scaled_material, 3>& chosen) const;

  measured<Metric> materials_;
  correction corrections_;
  correction_limits limits_;
  robust_start options_;
  thread_count threads_;
};

// ---- bodies, outside of the classes so that those of the metric `log` can be compiled once ---------------------

namespace detail {

template <error_metric Metric>
reweighted_combination<Metric>::reweighted_combination(measured<Metric> materials, const located_samples& samples,
                                                       thread_count threads)
    : materials_(std::move(materials)),
      functions_(materials_, samples.locations, threads),
      locations_(samples.locations),
      confidence_(samples.channel_weights()),
      mapped_(map_values(materials_.metric(), samples.channels(), locations_, threads)) {}

template <error_metric Metric>
solution reweighted_combination<Metric>::solve(const channel_values& inlier_weights) const {
  return combine({equations(0, inlier_weights), equations(1, inlier_weights), equations(2, inlier_weights)});
}

template <error_metric Metric>
solution reweighted_combination<Metric>::solve(const channel_values& inlier_weights,
                                               const reweighted_combination& others) const {
  const channel_values all = channel_values::Ones(3, std::ssize(others.locations_));
  const auto sum = [&](Eigen::Index c) { return equations(c, inlier_weights) + others.equations(c, all); };
  return combine({sum(0), sum(1), sum(2)});
}

template <error_metric Metric>
channel_values reweighted_combination<Metric>::values(const solution& found) const {
  channel_values values = functions_.apply(found.weights);
  for (Eigen::Index i = 0; i < values.cols(); ++i)
    for (float& value : values.col(i))
      value = static_cast<float>(std::clamp(materials_.metric().inverse(value, locations_[i]), 0.0,
                                            double{correction_factor::largest_estimate}));
  return values;
}

template <error_metric Metric>
channel_values reweighted_combination<Metric>::relative(const channel_values& estimates,
                                                        const std::array<float, 3>& offsets) const {
  constexpr double step = 1e-2;
  channel_values factors(3, estimates.cols());
  for (Eigen::Index i = 0; i < estimates.cols(); ++i)
    for (Eigen::Index c = 0; c < 3; ++c) {
      const location& at = locations_[i];
      const double rho = estimates(c, i), next = rho + step * (rho + offsets[c]);
      const double slope = materials_.metric().forward(next, at) - materials_.metric().forward(rho, at);
      factors(c, i) = static_cast<float>(std::pow(step / slope, 2));
    }
  return factors;
}

template <error_metric Metric>
normal_equations reweighted_combination<Metric>::equations(Eigen::Index channel,
                                                           const channel_values& inlier_weights) const {
  const auto row = channel;
  return functions_.normal(channel, inlier_weights.row(row) * confidence_.row(row), mapped_.row(row))
      .subset(functions_.columns());
}

template <error_metric Metric>
solution reweighted_combination<Metric>::combine(const std::array<normal_equations, 3>& equations) const {
  const nnls solver;
  const std::array<solution, 3> found{solver.solve(equations[0]), solver.solve(equations[1]),
                                      solver.solve(equations[2])};
  return scatter_columns(concatenate_columns(found), functions_.columns(), functions_.unknowns());
}

/// Makes a step in which a sample's weight is divided by its wanted factor sigma if sigma is above 1. Without the
/// division, some outliers would dominate despite small weights: the step minimises the squared error of sigma, which
/// is in the hundreds where the estimate is near zero.
template <class Run>
correction_round damped_step(Run& run, const channel_values& inlier_weights) {
  return run.step(inlier_weights / run.sigma().max(1.0f));
}

/// Returns weights that identify outliers separately in each region of the samples.
[[nodiscard]] inline automatic_weights weights_by_region(const located_samples& samples, thread_count threads) {
  return {.regions = std::make_shared<const sample_regions>(samples.locations), .threads = threads};
}

}  // namespace detail

template <error_metric Metric>
robust_run<Metric>::robust_run(run_type run, channel_values inlier_weights, int initial_weight_rounds)
    : run_(std::move(run)), inlier_weights_(std::move(inlier_weights)), initial_weight_rounds_(initial_weight_rounds) {}

template <error_metric Metric>
correction_round robust_run<Metric>::step() {
  return detail::damped_step(
      run_, std::ssize(run_.history()) < initial_weight_rounds_ ? inlier_weights_ : run_.inlier_weights());
}

template <error_metric Metric>
channel_values robust_run<Metric>::estimated() const {
  return run_.estimated();
}

template <error_metric Metric>
typename robust_run<Metric>::result_type robust_run<Metric>::result() const {
  return run_.result();
}

template <error_metric Metric>
robust_reconstruction<Metric>::robust_reconstruction(measured<Metric> materials, thread_count threads)
    : robust_reconstruction(materials, correction{materials, {}, nnls{}, threads}, {}, {}, threads) {}

template <error_metric Metric>
robust_reconstruction<Metric>::robust_reconstruction(measured<Metric> materials, correction corrections,
                                                     const correction_limits& limits, const robust_start& start,
                                                     thread_count threads)
    : materials_(std::move(materials)),
      corrections_(std::move(corrections)),
      limits_(limits),
      options_(start),
      threads_(threads) {
  if (!(materials_.cells() == corrections_.cells())) refuse("materials and corrections must be over the same cells");
}

template <error_metric Metric>
robust_run<Metric> robust_reconstruction<Metric>::initialise_located(const located_samples& all) const {
  const located_samples used = some_of(all, options_.most_samples);
  const auto [initial, guide] = initial_state_of(some_of(used, options_.samples));
  const automatic_weights weighting = detail::weights_by_region(used, threads_);
  run_type run{initial, corrections_, used, weighting, nnls{}, limits_, threads_};
  channel_values inlier_weights = weighting.weigh(run.measured(), run.estimated_by(guide));
  return {std::move(run), std::move(inlier_weights), options_.initial_weight_rounds};
}

template <error_metric Metric>
located_samples robust_reconstruction<Metric>::some_of(const located_samples& samples, Eigen::Index count) const {
  return samples.subset(random_choice(samples.size(), count, options_.seed));
}

template <error_metric Metric>
typename robust_reconstruction<Metric>::initial_state robust_reconstruction<Metric>::initial_state_of(
    const located_samples& some) const {
  const automatic_weights weighting = detail::weights_by_region(some, threads_);
  const channel_values measured = some.channels();
  const std::array<float, 3> offsets = automatic_weights::offsets(measured);
  const detail::reweighted_combination<Metric> combination(materials_, some, threads_);

  const nearest_material<Metric> nearest(materials_, options_.seed, threads_);
  const std::array<scaled_material, 3> chosen = nearest.choose(some);
  channel_values estimates = nearest.values(chosen, some.locations);
  solution found;
  for (int i = 0; i < options_.combinations; ++i) {
    found = combination.solve(weighting.weigh(measured, estimates) * combination.relative(estimates, offsets));
    estimates = combination.values(found);
  }
  run_type rough{initial_type{materials_, found}, corrections_, some, weighting, nnls{}, limits_, threads_};
  for (int i = 0; i < options_.corrections; ++i) detail::damped_step(rough, rough.inlier_weights());

  const automatic_weights whole{.down_weight_tail = false, .regions = weighting.regions, .threads = threads_};
  const detail::reweighted_combination<Metric> expected(materials_, expectation(nearest, chosen), threads_);
  const solution again = combination.solve(whole.weigh(measured, rough.estimated()), expected);
  return {initial_type{materials_, again}, std::move(rough)};
}

template <error_metric Metric>
located_samples robust_reconstruction<Metric>::expectation(const nearest_material<Metric>& nearest,
                                                           const std::array<scaled_material, 3>& chosen) const {
  const valid_cells& cells = materials_.cells();
  const Eigen::Index count = std::min<Eigen::Index>(cells.size(), 1'000);
  located_samples expected;
  for (Eigen::Index i = 0; i < count; ++i) expected.locations.push_back(locate_cell(cells, i * cells.size() / count));
  expected.values = nearest.values(chosen, expected.locations).template cast<double>().matrix().transpose();
  expected.weights =
      Eigen::MatrixXd::Constant(std::ssize(expected.locations), 1, options_.expectation / static_cast<double>(count));
  return expected;
}

#if defined(GONIO_COMPILED)
extern template class detail::reweighted_combination<log>;
extern template class robust_run<log>;
extern template class robust_reconstruction<log>;
#endif

}  // namespace gonio
