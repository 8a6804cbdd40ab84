#pragma once
/// Bodies of estimate/inliers.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/estimate/inliers.hpp>
#include <gonio/estimate/out_of_gamut.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/scaled_likelihood.hpp>
#include <gonio/estimate/solve_rows.hpp>
#include <gonio/solve/product.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE std::vector<Eigen::Index> inliers::kept() const {
  std::vector<Eigen::Index> positions;
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    if (weights[i] >= least_weight) positions.push_back(i);
  return positions;
}

GONIO_INLINE Eigen::Index outlying_sample::worst_channel() const {
  constexpr double floor = 1e-3;
  const auto factor = [this](Eigen::Index c) {
    const double ratio = (std::max(measured[c], 0.0) + floor) / (std::max(predicted[c], 0.0) + floor);
    return std::max(ratio, 1.0 / ratio);
  };
  Eigen::Index worst = 0;
  for (const Eigen::Index c : {1, 2})
    if (factor(c) > factor(worst)) worst = c;
  return worst;
}

GONIO_INLINE inliers detail::inliers_of_both(inliers first, const inliers& second) {
  for (Eigen::Index i = 0; i < first.weights.size(); ++i) first.weights[i] *= second.weights[i];
  const auto is_new = [&](Eigen::Index i) { return std::ranges::find(first.rejected, i) == first.rejected.end(); };
  for (const outlying_sample& each : second.contradicted)
    if (is_new(each.number) && std::ssize(first.contradicted) < most_contradicted) first.contradicted.push_back(each);
  for (const Eigen::Index i : second.rejected)
    if (is_new(i)) first.rejected.push_back(i);
  first.outlier_share += (1.0 - first.outlier_share) * second.outlier_share;
  return first;
}

GONIO_INLINE inliers all_inliers(Eigen::Index n) { return {Eigen::VectorXd::Ones(n), {}}; }

GONIO_INLINE located_samples weighted(const located_samples& samples, const inliers& found) {
  const std::vector<Eigen::Index> kept = found.kept();
  located_samples some = samples.subset(kept);
  for (Eigen::Index c = 0; c < some.weights.cols(); ++c)
    for (Eigen::Index i = 0; i < some.size(); ++i) some.weights(i, c) *= found.weights[kept[i]];
  return some;
}

namespace detail {

/// Returns inliers, given the probability that each sample is wrong. Among the rejected samples, lists those in `first`
/// first, then the others, the worst first.
[[nodiscard]] GONIO_INLINE inliers inliers_of(const Eigen::VectorXd& probabilities,
                                              const std::vector<Eigen::Index>& first) {
  const Eigen::Index n = probabilities.size();
  inliers found{Eigen::VectorXd(n), first};
  for (Eigen::Index i = 0; i < n; ++i) found.weights[i] = inlier_weight(probabilities[i]);
  std::vector<bool> is_named(n, false);
  for (const Eigen::Index i : first) is_named[i] = true;
  std::vector<std::pair<double, Eigen::Index>> by_weight;
  for (Eigen::Index i = 0; i < n; ++i)
    if (!is_named[i] && probabilities[i] > 0.5) by_weight.emplace_back(found.weights[i], i);
  for (const Eigen::Index i : in_order(std::move(by_weight))) found.rejected.push_back(i);
  if (n > 0) found.outlier_share = probabilities.sum() / static_cast<double>(n);
  return found;
}

/// Returns a number that identifies a neighbourhood of directions. Combines four integers between -500 and 500.
[[nodiscard]] GONIO_INLINE double neighbourhood_of(const half_difference& angles, const correlation_lengths& lengths) {
  double number = 0.0;
  for (const double coordinate : coordinates_of(angles, lengths)) number = 1000.0 * number + std::floor(coordinate);
  return number;
}

GONIO_INLINE std::vector<Eigen::Index> judged_together(const located_samples& samples) {
  const Eigen::Index n = samples.size();
  if (n <= most_judged) return random_choice(n, n, 0);
  // Number the samples of each neighbourhood, in a random order.
  std::mt19937_64 generator(0);
  std::vector<std::pair<double, Eigen::Index>> keyed;
  for (Eigen::Index i = 0; i < n; ++i) keyed.emplace_back(uniform_number(generator), i);
  const std::vector<Eigen::Index> random = in_order(std::move(keyed));
  std::vector<std::pair<double, Eigen::Index>> by_neighbourhood, by_rank;
  for (Eigen::Index k = 0; k < n; ++k)
    by_neighbourhood.emplace_back(
        neighbourhood_of(samples.locations[random[k]].angles, rejection_rule{}.everywhere_lengths), k);
  double rank = 0.0, last = -1.0;
  for (const Eigen::Index k : in_order(by_neighbourhood)) {
    rank = by_neighbourhood[k].first == last ? rank + 1.0 : 0.0;
    last = by_neighbourhood[k].first;
    by_rank.emplace_back(rank, k);
  }
  // Order the samples: first one sample of each neighbourhood, then a second sample of each, and so on.
  const std::vector<Eigen::Index> ordered = in_order(std::move(by_rank));
  // Choose two thirds at random, and the rest in this order.
  std::vector<Eigen::Index> chosen = random_choice(n, 2 * most_judged / 3, 0);
  std::vector<bool> is_chosen(n, false);
  for (const Eigen::Index i : chosen) is_chosen[i] = true;
  for (auto next = ordered.begin(); std::ssize(chosen) < most_judged; ++next)
    if (!is_chosen[random[*next]]) chosen.push_back(random[*next]);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// Returns the reflectance of materials at locations: locations x materials. A column of `weights` has the weights of a
/// material; `rows` has the prior's functions at the locations.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd materials_at(const prior_functions& prior, const Eigen::MatrixXd& rows,
                                                        const std::vector<location>& locations,
                                                        const Eigen::MatrixXd& weights, thread_count threads) {
  Eigen::MatrixXd values(rows.rows(), weights.cols());
  for_each_block(
      rows.rows(), 256,
      [&](block range) {
        Eigen::MatrixXd here = product(rows.middleRows(range.begin, range.size()), weights);
        prior.invert(std::span(locations).subspan(range.begin, range.size()), here);
        for (Eigen::Index j = 0; j < here.cols(); ++j) std::copy_n(&here(0, j), range.size(), &values(range.begin, j));
      },
      threads);
  return values;
}

/// Converts n x 3 values to `channel_values`.
[[nodiscard]] GONIO_INLINE channel_values by_channel(const Eigen::MatrixXd& values) {
  return located_samples{{}, values, {}}.channels();
}

/// For each channel, finds the material of the prior, and the factor on it, for which the measurements are most likely
/// a mixture of inliers and outliers. Returns the reflectance of this material at the samples. `materials` has the
/// reflectance of all observations of the prior: samples x observations. Works like `nearest_material`, but expands no
/// table. O(n m) for n samples and m observations.
[[nodiscard]] GONIO_INLINE channel_values nearest_at_samples(const Eigen::MatrixXd& materials,
                                                             const Eigen::MatrixXd& measured, thread_count threads) {
  const Eigen::Index n = measured.rows();
  Eigen::MatrixXd estimates(n, 3);
  for (Eigen::Index c = 0; c < 3; ++c) {
    std::vector<double> logarithms(&measured(0, c), &measured(0, c) + n), outliers;
    const double offset = logarithm_offset(logarithms);
    for (double& value : logarithms) value = std::max(value, 0.0) + offset;
    take_logarithms(logarithms.data(), n);
    const outlier_density density(logarithms);
    for (const double value : logarithms) outliers.push_back(density(value));
    std::vector<scaled_likelihood> found(materials.cols());
    for_each_block(
        materials.cols(), 1,
        [&](block one) {
          std::vector<double> differences(&materials(0, one.begin), &materials(0, one.begin) + n);
          for (double& value : differences) value += offset;
          take_logarithms(differences.data(), n);
          for (Eigen::Index i = 0; i < n; ++i) differences[i] = logarithms[i] - differences[i];
          found[one.begin] = best_factor(differences, outliers);
        },
        threads);
    Eigen::Index best = 0;
    for (Eigen::Index j = 1; j < materials.cols(); ++j)
      if (found[j].log_likelihood > found[best].log_likelihood) best = j;
    const double factor = std::exp(found[best].logarithm_of_factor);
    for (Eigen::Index i = 0; i < n; ++i) estimates(i, c) = factor * materials(i, best);
  }
  return by_channel(estimates);
}

/// Fits the weights of a prior's functions, k x 3, to the kept samples. `rows` has the k functions at all samples.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd fit_components(const Eigen::MatrixXd& rows, const located_samples& mapped,
                                                          const inliers& found, const tikhonov& solver,
                                                          thread_count threads) {
  const std::vector<Eigen::Index> kept = found.kept();
  const located_samples some = weighted(mapped, found);
  row_matrix equations(some.size(), rows.cols());
  for (Eigen::Index i = 0; i < equations.rows(); ++i)
    for (Eigen::Index k = 0; k < equations.cols(); ++k) equations(i, k) = rows(kept[i], k);
  return solve_rows(solver, rows_of(std::move(equations)), some, threads).weights;
}

/// Returns true for each sample that is probably an outlier of a fit by the prior's components alone: a start for the
/// search that resists many outliers. Begins with the nearest material, then alternates between fitting the components
/// and computing the probability that each sample is an inlier (Holland and Welsch 1977, doi:10.1080/03610927708827533,
/// with outlier_mixture.hpp). `rows` has the prior's functions at the samples. O(n k^2 + n m k) for n samples, k
/// components and m observations.
[[nodiscard]] GONIO_INLINE std::vector<bool> outliers_by_components(const prior_functions& prior,
                                                                    const Eigen::MatrixXd& rows,
                                                                    const located_samples& samples,
                                                                    const located_samples& mapped,
                                                                    double error_variance, thread_count threads) {
  constexpr int rounds = 8;
  const tikhonov solver(static_cast<double>(prior.coefficients.cols()) * error_variance);
  const automatic_weights weighting{.down_weight_tail = false, .threads = threads};
  const channel_values measured = samples.channels();
  const auto reflectance = [&](const Eigen::MatrixXd& weights) {
    return materials_at(prior, rows, samples.locations, weights, threads);
  };
  inliers found = all_inliers(samples.size());
  const auto weigh = [&](const channel_values& estimated) {
    const channel_values weights = weighting.weigh(measured, estimated);
    for (Eigen::Index i = 0; i < found.weights.size(); ++i) found.weights[i] = double{weights(0, i)};
  };
  weigh(nearest_at_samples(reflectance(prior.coefficients), samples.values, threads));
  for (int round = 0; round < rounds && !found.kept().empty(); ++round)
    weigh(by_channel(reflectance(fit_components(rows, mapped, found, solver, threads))));
  std::vector<bool> wrong(samples.size());
  for (Eigen::Index i = 0; i < samples.size(); ++i) wrong[i] = found.weights[i] < 0.5;
  return wrong;
}

/// Returns the first `most_contradicted` of the wrong samples, with predictions from the samples that are not wrong.
[[nodiscard]] GONIO_INLINE std::vector<outlying_sample> told_by_others(const prior_functions& prior,
                                                                       const located_samples& samples,
                                                                       const sample_process& process,
                                                                       const std::vector<wrong_sample>& wrong) {
  std::vector<Eigen::Index> numbers;
  for (const wrong_sample& each : wrong) numbers.push_back(each.number);
  if (numbers.empty()) return {};
  sample_predictions others = process.predicted_without(numbers);
  prior.invert(samples.subset(numbers).locations, others.mean);
  std::vector<outlying_sample> told;
  for (Eigen::Index i = 0; i < std::min(std::ssize(wrong), most_contradicted); ++i)
    told.push_back({.number = numbers[i],
                    .measured = first_three(samples.values, numbers[i]),
                    .predicted = first_three(others.mean, i),
                    .deviation = others.deviation[i],
                    .probability = wrong[i].probability});
  return told;
}

/// Finds the wrong samples in groups of a material's samples. `mapped` has all samples in the prior's domain.
class sample_judge {
 public:
  sample_judge(const prior_functions& prior, const expected_covariance& expected, const located_samples& mapped,
               const Eigen::VectorXd& error_variances, thread_count threads)
      : prior_(prior), expected_(expected), mapped_(mapped), error_variances_(error_variances), threads_(threads) {}

  [[nodiscard]] sample_process process_of(const std::vector<Eigen::Index>& positions) const {
    const located_samples some = mapped_.subset(positions);
    Eigen::VectorXd errors(some.size());
    for (Eigen::Index i = 0; i < errors.size(); ++i) errors[i] = error_variances_[positions[i]];
    return {expected_, prior_.rows(some.locations), some, errors};
  }

  /// Returns the probability that each sample is wrong. `judged` has this probability for the samples at `positions`;
  /// all other samples are compared with these.
  [[nodiscard]] Eigen::VectorXd probabilities(const judged_samples& judged,
                                              const std::vector<Eigen::Index>& positions) const {
    Eigen::VectorXd found(mapped_.size());
    std::vector<bool> is_judged(mapped_.size(), false);
    for (Eigen::Index i = 0; i < std::ssize(positions); ++i) {
      found[positions[i]] = judged.probabilities()[i];
      is_judged[positions[i]] = true;
    }
    std::vector<Eigen::Index> others;
    for (Eigen::Index i = 0; i < mapped_.size(); ++i)
      if (!is_judged[i]) others.push_back(i);
    for_each_block(
        std::ssize(others), 512,
        [&](block range) {
          const std::vector<Eigen::Index> here(others.begin() + range.begin, others.begin() + range.end);
          const located_samples some = mapped_.subset(here);
          Eigen::VectorXd errors(some.size());
          for (Eigen::Index i = 0; i < errors.size(); ++i) {
            double sum = 0.0;
            for (Eigen::Index c = 0; c < some.weights.cols(); ++c) sum += some.weights(i, c);
            errors[i] = error_variances_[here[i]] / (sum / static_cast<double>(some.weights.cols()));
          }
          const Eigen::VectorXd wrong = judged.probabilities(prior_.rows(some.locations), some.values, errors);
          for (Eigen::Index i = 0; i < errors.size(); ++i) found[here[i]] = wrong[i];
        },
        threads_);
    return found;
  }

 private:
  const prior_functions& prior_;
  const expected_covariance& expected_;
  const located_samples& mapped_;
  const Eigen::VectorXd& error_variances_;
  thread_count threads_;
};

}  // namespace detail

GONIO_INLINE inliers detail::find_inliers(const prior_functions& prior, const expected_covariance& expected,
                                          const located_samples& samples, const located_samples& mapped,
                                          const Eigen::VectorXd& error_variances,
                                          const std::optional<sample_process>& all, thread_count threads) {
  // Convert negative values, which a logarithm does not distinguish.
  const std::optional<located_samples> in_gamut = out_of_gamut_as_xyz(samples);
  const located_samples& judged = in_gamut ? *in_gamut : samples;
  const located_samples judged_mapped = in_gamut ? prior.map(judged) : mapped;

  // Judge some samples together, and compare all other samples with these.
  const sample_judge judge(prior, expected, judged_mapped, error_variances, threads);
  const std::vector<Eigen::Index> positions = judged_together(samples);
  const located_samples some = judged.subset(positions), some_mapped = judged_mapped.subset(positions);
  const bool has_all = all && samples.size() <= most_judged;
  const sample_process process = has_all ? all->with_values(some_mapped.values) : judge.process_of(positions);
  const std::vector<std::vector<bool>> starts{
      outliers_by_components(prior, process.at().rows, some, some_mapped, expected.model.error_variance, threads)};
  const judged_samples found = judge_samples(process, {}, starts);
  const Eigen::VectorXd wrong = judge.probabilities(found, positions);
  // List the wrong samples with their predictions, in the colours that were measured.
  std::vector<Eigen::Index> numbers;
  for (const wrong_sample& each : found.wrong()) numbers.push_back(positions[each.number]);
  inliers told = inliers_of(wrong, numbers);
  told.contradicted = told_by_others(prior, samples.subset(positions),
                                     process.with_values(mapped.subset(positions).values), found.wrong());
  for (outlying_sample& each : told.contradicted) each.number = positions[each.number];
  return told;
}

}  // namespace gonio
