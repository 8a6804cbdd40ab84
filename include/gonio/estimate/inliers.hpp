#pragma once
/// Which samples of a material to believe, at any number of them: those that their process does not call wrong
/// (wrong_samples.hpp). Of more than `most_judged` samples so many at random are judged together, and each of the
/// others by these; those that are called wrong where most samples are called so are heard again, together. The search
/// for wrong samples starts from what the nearest material of the prior says, too, which outliers cannot drag along.
/// Why so: docs/decisions/0020-wrong-samples.md; results: docs/results/real-materials.md, docs/results/real-methods.md.

#include <gonio/basis/pca.hpp>
#include <gonio/core/random.hpp>
#include <gonio/estimate/basis_equations.hpp>
#include <gonio/estimate/out_of_gamut.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/sample_process.hpp>
#include <gonio/estimate/scaled_likelihood.hpp>
#include <gonio/estimate/wrong_samples.hpp>
#include <gonio/solve/product.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

/// So many samples are judged together, by a process of all of them.
inline constexpr Eigen::Index most_judged = 500;
/// Of so many that the others contradict, what these say is told.
inline constexpr Eigen::Index most_contradicted = 20;

/// A sample that the others contradict, for people.
struct outlying_sample {
  Eigen::Index number = 0;   ///< its position among the samples
  rgb measured;              ///< sr^-1
  rgb predicted;             ///< sr^-1, from all that are not contradicted
  double deviation = 0.0;    ///< of the prediction, in the metric's domain: relative where that is a logarithm
  double probability = 0.0;  ///< that the sample is wrong
};

/// What was found about n samples.
struct inliers {
  Eigen::VectorXd weights;             ///< what each counts, the probability that it is right
  std::vector<Eigen::Index> rejected;  ///< positions of those that count less than half, the worst first
  /// The first of them, `most_contradicted` at most and of those that are judged together, with what the others say.
  std::vector<outlying_sample> contradicted = {};
  double outlier_share = 0.0;  ///< of all samples, the sum of what they do not count

  /// Positions of the samples that count. What counts less than 0.01 does not.
  [[nodiscard]] std::vector<Eigen::Index> kept() const;
};

/// All of n samples.
[[nodiscard]] inliers all_inliers(Eigen::Index n);

/// The largest share of n samples that a count of outliers may state: 60 %, less 7.2 samples. What disagrees with a
/// dozen others may as well be a highlight: of twelve samples none, of 20 at most 24 %, of 100 at most 53 %.
[[nodiscard]] inline double largest_outlier_share(Eigen::Index n) noexcept {
  return n <= 12 ? 0.0 : 0.6 - 7.2 / static_cast<double>(n);
}

/// Some samples, each of which counts as much as it did times its inlier weight.
[[nodiscard]] located_samples weighted(const located_samples& samples, const inliers& found);

namespace detail {

/// Of the probabilities that samples are wrong; the worst first, of those that are equally bad `first` before others.
[[nodiscard]] inliers inliers_of(const Eigen::VectorXd& probabilities, const std::vector<Eigen::Index>& first);

/// Of samples that are wrong with some probabilities, those that are more likely wrong than not, and so are three of
/// four samples in their neighbourhood, of a correlation length in size, but not they alone. O(n log n).
[[nodiscard]] std::vector<Eigen::Index> wrong_neighbours(const located_samples& samples,
                                                         const Eigen::VectorXd& probabilities,
                                                         const correlation_lengths& lengths);

/// Numbers of some numbers: those at some positions.
[[nodiscard]] std::vector<Eigen::Index> numbers_at(const std::vector<Eigen::Index>& numbers,
                                                   const std::vector<Eigen::Index>& positions);

/// The first three numbers of a row.
[[nodiscard]] inline rgb first_three(const Eigen::MatrixXd& values, Eigen::Index row) {
  return {values(row, 0), values(row, 1), values(row, 2)};
}

/// The reflectance of materials, given their coefficients in rows, at locations: locations x rows.
template <error_metric Metric>
[[nodiscard]] Eigen::MatrixXd materials_at(const pca<Metric>& prior, const std::vector<location>& locations,
                                           const Eigen::MatrixXd& coefficients, thread_count threads) {
  const Eigen::MatrixXd functions_by_material = coefficients.transpose();
  Eigen::MatrixXd values(std::ssize(locations), coefficients.rows());
  for_each_block(
      std::ssize(locations), 256,
      [&](block range) {
        const auto here = std::span(locations).subspan(range.begin, range.size());
        const Eigen::MatrixXd mapped = product(rows_at(prior, here), functions_by_material);
        for (Eigen::Index i = 0; i < range.size(); ++i) {
          const location& at = here[i];
          const double offset = offset_at(prior, at);
          for (Eigen::Index j = 0; j < mapped.cols(); ++j)
            values(range.begin + i, j) = reflectance_of(prior.metric(), mapped(i, j) + offset, at);
        }
      },
      threads);
  return values;
}

/// For each channel the material of the prior, brightened or darkened, under which the samples are most likely a
/// mixture of inliers and outliers: its reflectance at them. As `nearest_material`, but no table is expanded. O(n m k)
/// for m materials.
template <error_metric Metric>
[[nodiscard]] channel_values nearest_at_samples(const pca<Metric>& prior, const located_samples& samples,
                                                thread_count threads) {
  const Eigen::MatrixXd materials =
      materials_at(prior, samples.locations, prior.coefficients().template cast<double>(), threads);
  channel_values estimates(3, samples.size());
  for (Eigen::Index c = 0; c < 3; ++c) {
    // Find the likelihood of each material, each with its best factor.
    const double offset = logarithm_offset(samples.values.col(c));
    const Eigen::ArrayXd logarithms = (samples.values.col(c).array().max(0.0) + offset).log();
    const outlier_density density({logarithms.begin(), logarithms.end()});
    const Eigen::ArrayXd outliers = logarithms.unaryExpr([&](double value) { return density(value); });
    std::vector<scaled_likelihood> found(materials.cols());
    for_each_block(
        materials.cols(), 1,
        [&](block one) {
          const Eigen::ArrayXd differences = logarithms - (materials.col(one.begin).array() + offset).log();
          found[one.begin] = best_factor(differences, outliers);
        },
        threads);
    // Take the best one.
    const auto best = std::ranges::max_element(found, {}, &scaled_likelihood::log_likelihood);
    estimates.row(c) =
        (std::exp(best->logarithm_of_factor) * materials.col(best - found.begin())).template cast<float>().transpose();
  }
  return estimates;
}

/// Those that look like outliers beside the prior's components alone: a start that many outliers cannot drag along. The
/// components are fitted in turns with the probabilities that samples are inliers (Holland and Welsch 1977,
/// doi:10.1080/03610927708827533, with outlier_mixture.hpp), from the nearest material on. O(n k^2 + n m k).
template <error_metric Metric>
[[nodiscard]] std::vector<bool> outliers_by_components(const pca<Metric>& prior, const located_samples& samples,
                                                       const located_samples& mapped, double error_variance,
                                                       thread_count threads) {
  constexpr int rounds = 8;
  const tikhonov solver(static_cast<double>(prior.coefficients().rows()) * error_variance);
  const automatic_weights weighting{.down_weight_tail = false, .threads = threads};
  const channel_values measured = samples.channels();
  channel_values weights = weighting.weigh(measured, nearest_at_samples(prior, samples, threads));
  for (int round = 0; round < rounds; ++round) {
    const inliers found{weights.row(0).transpose().template cast<double>(), {}};
    if (found.kept().empty()) break;
    const auto equations = basis_equations<pca<Metric>>::of_mapped(prior, weighted(mapped, found), threads);
    const Eigen::MatrixXd values =
        materials_at(prior, samples.locations, equations.solve(solver).weights.transpose(), threads);
    weights = weighting.weigh(measured, values.template cast<float>().transpose());
  }
  std::vector<bool> wrong(samples.size());
  for (Eigen::Index i = 0; i < samples.size(); ++i) wrong[i] = weights(0, i) < 0.5f;
  return wrong;
}

/// What the samples that are not contradicted make of the first of those that are, of samples that a process is of.
template <error_metric Metric>
[[nodiscard]] std::vector<outlying_sample> told_by_others(const pca<Metric>& prior, const located_samples& samples,
                                                          const sample_process& process,
                                                          const std::vector<wrong_sample>& wrong) {
  std::vector<Eigen::Index> numbers;
  for (const wrong_sample& each : wrong) numbers.push_back(each.number);
  if (numbers.empty()) return {};
  const sample_predictions others = process.predicted_without(numbers);
  std::vector<outlying_sample> told;
  for (Eigen::Index i = 0; i < std::min(std::ssize(wrong), most_contradicted); ++i) {
    const location& at = samples.locations[numbers[i]];
    const double offset = offset_at(prior, at);
    outlying_sample out{.number = numbers[i],
                        .measured = first_three(samples.values, numbers[i]),
                        .predicted = rgb::Zero(),
                        .deviation = others.deviation[i],
                        .probability = wrong[i].probability};
    for (Eigen::Index c = 0; c < 3; ++c)
      out.predicted[c] = reflectance_of(prior.metric(), others.mean(i, c) + offset, at);
    told.push_back(out);
  }
  return told;
}

/// Judges samples of a material in groups. `mapped` are all of them in the prior's domain.
template <error_metric Metric>
class sample_judge {
 public:
  sample_judge(const pca<Metric>& prior, const expected_covariance& expected, const located_samples& mapped,
               const Eigen::VectorXd& error_variances, thread_count threads)
      : prior_(prior), expected_(expected), mapped_(mapped), error_variances_(error_variances), threads_(threads) {}

  [[nodiscard]] sample_process process_of(const std::vector<Eigen::Index>& positions) const {
    const located_samples some = mapped_.subset(positions);
    Eigen::VectorXd errors(some.size());
    for (Eigen::Index i = 0; i < errors.size(); ++i) errors[i] = error_variances_[positions[i]];
    return {expected_, locate_rows(prior_, some.locations), some, errors};
  }

  /// The probabilities that samples are wrong: of those that were judged, at `positions`, and by them of all others.
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
          for (Eigen::Index i = 0; i < errors.size(); ++i)
            errors[i] = error_variances_[here[i]] / some.weights.row(i).mean();
          const Eigen::VectorXd wrong = judged.probabilities(locate_rows(prior_, some.locations), some.values, errors);
          for (Eigen::Index i = 0; i < errors.size(); ++i) found[here[i]] = wrong[i];
        },
        threads_);
    return found;
  }

  /// Of those that are called wrong, none whose neighbours are, too, is wrong if a judgement of these and others
  /// together does not say so: a narrow highlight of which a random choice has one sample.
  [[nodiscard]] Eigen::VectorXd heard_again(Eigen::VectorXd wrong, const std::vector<Eigen::Index>& first) const {
    const std::vector<Eigen::Index> doubted = wrong_neighbours(mapped_, wrong, rejection_rule{}.highlight_lengths);
    if (doubted.empty()) return wrong;
    std::vector<Eigen::Index> together = numbers_at(doubted, random_choice(std::ssize(doubted), most_judged / 3, 0));
    const auto others = numbers_at(first, random_choice(std::ssize(first), most_judged - std::ssize(together), 0));
    together.insert(together.end(), others.begin(), others.end());
    std::ranges::sort(together);
    together.erase(std::unique(together.begin(), together.end()), together.end());
    std::vector<std::vector<bool>> starts(1);
    for (const Eigen::Index i : together) starts[0].push_back(wrong[i] > 0.5);
    const judged_samples judged = judge_samples(process_of(together), {}, starts);
    const Eigen::VectorXd again = probabilities(judged, together);
    for (const Eigen::Index i : doubted) wrong[i] = std::min(wrong[i], again[i]);
    return wrong;
  }

 private:
  const pca<Metric>& prior_;
  const expected_covariance& expected_;
  const located_samples& mapped_;
  const Eigen::VectorXd& error_variances_;
  thread_count threads_;
};

}  // namespace detail

/// The inliers of samples in colours: `mapped` are the same in the prior's domain (`map_samples`), `error_variances`
/// those of each one's error. `all` is the process of all of them, if there is one: it is used for up to `most_judged`.
/// For n samples, j of them judged together, k components and m materials: what `judge_samples` does for j, O(n j (j +
/// k)), and O(j m k).
template <error_metric Metric>
[[nodiscard]] inliers find_inliers(const pca<Metric>& prior, const expected_covariance& expected,
                                   const located_samples& samples, const located_samples& mapped,
                                   const Eigen::VectorXd& error_variances,
                                   const std::optional<sample_process>& all = {}, thread_count threads = {}) {
  // A logarithm does not tell apart what is negative.
  const std::optional<located_samples> in_gamut = out_of_gamut_as_xyz(samples);
  const std::optional<located_samples> in_gamut_mapped =
      in_gamut ? std::optional(map_samples(prior, *in_gamut, threads)) : std::nullopt;
  const located_samples& judged = in_gamut ? *in_gamut : samples;
  const located_samples& judged_mapped = in_gamut ? *in_gamut_mapped : mapped;

  // Judge some together, and all others by these.
  const detail::sample_judge judge(prior, expected, judged_mapped, error_variances, threads);
  const std::vector<Eigen::Index> positions = random_choice(samples.size(), most_judged, 0);
  const located_samples some = judged.subset(positions), some_mapped = judged_mapped.subset(positions);
  const bool has_all = all && samples.size() <= most_judged;
  const sample_process process = has_all ? all->with_values(some_mapped.values) : judge.process_of(positions);
  const std::vector<std::vector<bool>> starts{
      detail::outliers_by_components(prior, some, some_mapped, expected.model.error_variance, threads)};
  const judged_samples found = judge_samples(process, {}, starts);
  Eigen::VectorXd wrong = judge.probabilities(found, positions);
  if (samples.size() > most_judged) wrong = judge.heard_again(std::move(wrong), positions);
  // Name them, and tell what the others say, in the colours that were measured.
  std::vector<wrong_sample> worst;
  std::vector<Eigen::Index> numbers;
  for (const wrong_sample& each : found.wrong())
    if (wrong[positions[each.number]] > 0.5) worst.push_back(each);
  for (const wrong_sample& each : worst) numbers.push_back(positions[each.number]);
  inliers told = detail::inliers_of(wrong, numbers);
  told.contradicted = detail::told_by_others(prior, samples.subset(positions),
                                             process.with_values(mapped.subset(positions).values), worst);
  for (outlying_sample& each : told.contradicted) each.number = positions[each.number];
  return told;
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/inliers.ipp>
#endif
