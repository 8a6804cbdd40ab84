#pragma once
/// Which samples of a material to believe. Of few samples, those that all others contradict are rejected: each is
/// predicted from the others in closed form (`sample_process`). Of many, the prior's components are fitted again and
/// again, each time with the samples weighted by the probability that they are inliers (iteratively reweighted least
/// squares, Holland and Welsch 1977, doi:10.1080/03610927708827533, with the weights of outlier_mixture.hpp), from a
/// start that outliers cannot drag along. Why so, and the numbers of samples at which it changes:
/// docs/decisions/0020-wrong-samples.md; results: docs/results/real-materials.md, docs/results/real-methods.md.

#include <gonio/basis/pca.hpp>
#include <gonio/core/random.hpp>
#include <gonio/estimate/basis_equations.hpp>
#include <gonio/estimate/out_of_gamut.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/sample_process.hpp>
#include <gonio/estimate/scaled_likelihood.hpp>
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

/// Of fewer samples none is rejected: one that disagrees may be the only one in the highlight.
inline constexpr Eigen::Index fewest_rejected = 13;
/// From so many samples on each is weighed, and none is named.
inline constexpr Eigen::Index fewest_weighed = 100;

/// What is expected of wrong samples, and when one is rejected. The defaults were chosen on measured materials, with
/// two wrong of twenty and with none (docs/results/real-materials.md).
struct rejection_rule {
  double expected_number = 0.2;  ///< of wrong samples among all; of one sample in two at most
  /// Standard deviations of a wrong sample's error in the metric's domain: of what its channels have in common (where
  /// that is a logarithm, 1.7 is a factor of 5), and of each channel beside.
  double common_error = 1.7, channel_error = 0.3;
  double least_probability = 0.75;  ///< of being wrong, for a sample to be rejected
  double largest_share = 0.2;       ///< of the samples are rejected at most, and at least one
};

struct wrong_sample {
  Eigen::Index number = 0;   ///< its position among the samples
  double probability = 0.0;  ///< that it is wrong
};

/// The set of wrong samples of the largest probability that a search finds, without those below the rule's least; the
/// most probable first. A wrong sample has an error of large variance. Sets are compared by their probability given all
/// samples, the scale of all variances unknown: where the model is poor all samples disagree a little, and none is an
/// outlier. Mixtures of good and bad observations: Box and Tiao 1968 (doi:10.1093/biomet/55.1.119). O(n^3 + n^2
/// rejected). Throws gonio::error for an impossible rule.
[[nodiscard]] std::vector<wrong_sample> find_wrong_samples(const sample_process& samples,
                                                           const rejection_rule& rule = {});

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
  Eigen::VectorXd weights;             ///< what each counts, from 0 (an outlier) to 1
  std::vector<Eigen::Index> rejected;  ///< positions of those that count less than half, the worst first
  /// Those that the others contradict, the worst first; they count all the same if there are fewer than
  /// `fewest_rejected`. Empty from `fewest_weighed` on.
  std::vector<outlying_sample> contradicted = {};
  double outlier_share = 0.0;  ///< of all samples, the sum of what they do not count

  /// Positions of the samples that count. What counts less than 0.01 does not.
  [[nodiscard]] std::vector<Eigen::Index> kept() const;
};

/// All of n samples.
[[nodiscard]] inliers all_inliers(Eigen::Index n);

/// The largest share of n samples that may be outliers: 60 %, less 7.2 samples. What disagrees with a dozen others may
/// as well be a highlight: of twelve samples none is called an outlier, of 20 at most 24 %, of 100 at most 53 %.
[[nodiscard]] inline double largest_outlier_share(Eigen::Index n) noexcept {
  return n <= 12 ? 0.0 : 0.6 - 7.2 / static_cast<double>(n);
}

/// Raises inlier weights, all by one factor and to 1 at most, until so many that no more than `largest_outlier_share`
/// are left count in full. O(n).
[[nodiscard]] Eigen::VectorXd limit_outliers(const Eigen::VectorXd& inlier_weights);

/// Some samples, each of which counts as much as it did times its inlier weight.
[[nodiscard]] located_samples weighted(const located_samples& samples, const inliers& found);

namespace detail {

[[nodiscard]] inliers weighed_inliers(Eigen::VectorXd weights);

/// The first three numbers of a row.
[[nodiscard]] inline rgb first_three(const Eigen::MatrixXd& values, Eigen::Index row) {
  return {values(row, 0), values(row, 1), values(row, 2)};
}

/// The rounds of weighting samples and fitting components again, and the start: the nearest material of the prior.
template <error_metric Metric>
class inlier_rounds {
 public:
  inlier_rounds(const pca<Metric>& prior, double error_variance, thread_count threads)
      : prior_(prior), solver_(static_cast<double>(prior.coefficients().rows()) * error_variance), threads_(threads) {}

  [[nodiscard]] Eigen::VectorXd weigh(const located_samples& samples, const located_samples& mapped) const {
    constexpr int rounds = 8;
    const automatic_weights weighting{.down_weight_tail = false, .threads = threads_};
    const channel_values measured = samples.channels();
    const auto weights_by = [&](const channel_values& estimated) {
      return limit_outliers(weighting.weigh(measured, estimated).row(0).transpose().template cast<double>());
    };
    Eigen::VectorXd weights = weights_by(nearest(samples));
    for (int round = 0; round < rounds; ++round) {
      const auto equations = basis_equations<pca<Metric>>::of_mapped(prior_, weighted(mapped, {weights, {}}), threads_);
      const Eigen::MatrixXd values = materials_at(samples.locations, equations.solve(solver_).weights.transpose());
      weights = weights_by(values.template cast<float>().transpose());
    }
    return weights;
  }

 private:
  /// For each channel the material of the prior, brightened or darkened, under which the samples are most likely a
  /// mixture of inliers and outliers: its reflectance at them. As `nearest_material`, but no table is expanded.
  [[nodiscard]] channel_values nearest(const located_samples& samples) const {
    constexpr Eigen::Index looked_at = 1500;
    const located_samples some = samples.subset(random_choice(samples.size(), looked_at, 0));
    const Eigen::MatrixXd materials = materials_at(some.locations, prior_.coefficients().template cast<double>());
    channel_values estimates(3, samples.size());
    for (Eigen::Index c = 0; c < 3; ++c) {
      // Find the likelihood of each material, each with its best factor.
      const double offset = logarithm_offset(samples.values.col(c));
      const Eigen::ArrayXd logarithms = (some.values.col(c).array().max(0.0) + offset).log();
      const outlier_density density({logarithms.begin(), logarithms.end()});
      const Eigen::ArrayXd outliers = logarithms.unaryExpr([&](double value) { return density(value); });
      std::vector<scaled_likelihood> found(materials.cols());
      for_each_block(
          materials.cols(), 1,
          [&](block one) {
            const Eigen::ArrayXd differences = logarithms - (materials.col(one.begin).array() + offset).log();
            found[one.begin] = best_factor(differences, outliers);
          },
          threads_);
      // Take the best one.
      const auto best = std::ranges::max_element(found, {}, &scaled_likelihood::log_likelihood);
      const Eigen::MatrixXf coefficients = prior_.coefficients().row(best - found.begin());
      const Eigen::MatrixXd values = materials_at(samples.locations, coefficients.cast<double>());
      estimates.row(c) = (std::exp(best->logarithm_of_factor) * values).cast<float>().transpose();
    }
    return estimates;
  }

  /// The reflectance of materials, or of channels, given their coefficients in rows, at locations: locations x rows.
  [[nodiscard]] Eigen::MatrixXd materials_at(const std::vector<location>& locations,
                                             const Eigen::MatrixXd& coefficients) const {
    const Eigen::MatrixXd functions_by_material = coefficients.transpose();
    Eigen::MatrixXd values(std::ssize(locations), coefficients.rows());
    for_each_block(
        std::ssize(locations), 256,
        [&](block range) {
          const auto here = std::span(locations).subspan(range.begin, range.size());
          const Eigen::MatrixXd mapped = product(rows_at(prior_, here), functions_by_material);
          for (Eigen::Index i = 0; i < range.size(); ++i) {
            const location& at = here[i];
            const double offset = offset_at(prior_, at);
            for (Eigen::Index j = 0; j < mapped.cols(); ++j)
              values(range.begin + i, j) = reflectance_of(prior_.metric(), mapped(i, j) + offset, at);
          }
        },
        threads_);
    return values;
  }

  const pca<Metric>& prior_;
  tikhonov solver_;
  thread_count threads_;
};

/// What the samples that are not contradicted make of those that are.
template <error_metric Metric>
[[nodiscard]] std::vector<outlying_sample> told_by_others(const pca<Metric>& prior, const located_samples& samples,
                                                          const sample_process& process,
                                                          const std::vector<wrong_sample>& wrong) {
  std::vector<Eigen::Index> numbers;
  for (const wrong_sample& each : wrong) numbers.push_back(each.number);
  if (numbers.empty()) return {};
  const sample_predictions others = process.predicted_without(numbers);
  std::vector<outlying_sample> told;
  for (Eigen::Index i = 0; i < std::ssize(wrong); ++i) {
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

}  // namespace detail

/// What each of n samples in colours counts, from 0 (an outlier) to 1, of which most may be outliers: the prior's
/// components are fitted eight times. `mapped` are the same in the prior's domain (`map_samples`). O(8 n k^2 + 1500 m
/// k) for k components and m materials.
template <error_metric Metric>
[[nodiscard]] Eigen::VectorXd weigh_inliers(const pca<Metric>& prior, const located_samples& samples,
                                            const located_samples& mapped, double error_variance,
                                            thread_count threads = {}) {
  return detail::inlier_rounds<Metric>(prior, error_variance, threads).weigh(samples, mapped);
}

/// The inliers of samples in colours: `mapped` are the same in the prior's domain (`map_samples`), `process` is theirs,
/// which fewer than `fewest_weighed` need. Costs what `find_wrong_samples` does, or O(8 n k^2 + 1500 m k) for n
/// samples, k components and m materials.
template <error_metric Metric>
[[nodiscard]] inliers find_inliers(const pca<Metric>& prior, const located_samples& samples,
                                   const located_samples& mapped, const std::optional<sample_process>& process,
                                   double error_variance, thread_count threads = {}) {
  // A logarithm does not tell apart what is negative.
  const std::optional<located_samples> in_gamut = out_of_gamut_as_xyz(samples);
  const std::optional<located_samples> in_gamut_mapped =
      in_gamut ? std::optional(map_samples(prior, *in_gamut, threads)) : std::nullopt;
  const located_samples& judged = in_gamut ? *in_gamut : samples;
  const located_samples& judged_mapped = in_gamut ? *in_gamut_mapped : mapped;

  if (samples.size() >= fewest_weighed)
    return detail::weighed_inliers(weigh_inliers(prior, judged, judged_mapped, error_variance, threads));
  inliers found = all_inliers(samples.size());
  found.contradicted = detail::told_by_others(
      prior, samples, *process, find_wrong_samples(in_gamut ? process->with_values(judged_mapped.values) : *process));
  if (samples.size() < fewest_rejected) return found;
  for (const outlying_sample& out : found.contradicted) {
    found.rejected.push_back(out.number);
    found.weights[out.number] = 0.0;
  }
  found.outlier_share = static_cast<double>(found.rejected.size()) / static_cast<double>(samples.size());
  return found;
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/inliers.ipp>
#endif
