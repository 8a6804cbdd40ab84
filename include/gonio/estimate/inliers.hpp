#pragma once
/// Finds the inliers among the samples of a material, by the probability that each sample is wrong (wrong_samples.hpp).
/// If there are many samples, some are judged together, and each remaining sample is compared with these. The search
/// for wrong samples also starts from the nearest material of the prior, on which outliers have little effect. Reasons:
/// docs/decisions/0020-wrong-samples.md; results: docs/results/real-materials.md, docs/results/real-methods.md.

#include <gonio/basis/pca.hpp>
#include <gonio/estimate/map_samples.hpp>
#include <gonio/estimate/sample_process.hpp>
#include <gonio/estimate/wrong_samples.hpp>

#include <Eigen/Core>

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// The largest number of samples that are judged together, by one process.
inline constexpr Eigen::Index most_judged = 500;
/// The largest number of contradicted samples that are reported with their predictions.
inline constexpr Eigen::Index most_contradicted = 20;

/// A sample that all other samples together contradict, for reports.
struct outlying_sample {
  Eigen::Index number = 0;   ///< its position among the samples
  rgb measured;              ///< sr^-1
  rgb predicted;             ///< sr^-1, from all samples that are not contradicted
  double deviation = 0.0;    ///< combined standard deviation of prediction and sample, in the metric's domain
  double probability = 0.0;  ///< probability that the sample is wrong
  /// The names of the three channels: colours, or ranges of wavelengths (`channels::names_of_three`).
  std::array<std::string, 3> channel_names = channels().names_of_three();

  /// Returns the channel in which measured and predicted value differ by the largest factor. Negative values count as
  /// zero, and 0.001 sr^-1 is added to both values.
  [[nodiscard]] Eigen::Index worst_channel() const;
};

/// The inliers among n samples.
struct inliers {
  /// Samples of smaller weight are left out.
  static constexpr double least_weight = 0.01;

  Eigen::VectorXd weights;             ///< the weight of each sample in a fit, from 0 to 1 (`inlier_weight`)
  std::vector<Eigen::Index> rejected;  ///< positions of the samples that are probably wrong, the worst first
  /// The first `most_contradicted` of those rejected samples that were judged together, with their predictions.
  std::vector<outlying_sample> contradicted = {};
  double outlier_share = 0.0;  ///< the mean probability that a sample is wrong

  /// Returns the positions of the samples whose weight is at least `least_weight`.
  [[nodiscard]] std::vector<Eigen::Index> kept() const;
};

/// Returns the weight in a fit of a sample that is wrong with probability p: 1 / (1 + 10 p / (1 - p)). The factor is 10
/// because the variance that the other samples leave is about ten times the error variance of a right sample. With a
/// weight of 1 - p, the sample would still determine most of the estimate.
[[nodiscard]] inline double inlier_weight(double probability_wrong) noexcept {
  const double right = 1.0 - probability_wrong;
  return right / (right + 10.0 * probability_wrong);
}

/// Returns n inliers of weight 1.
[[nodiscard]] inliers all_inliers(Eigen::Index n);

/// Returns the largest fraction of outliers to report for n samples: 0.6 - 7.2 / n, which is 0 up to 12 samples, 24 %
/// for 20 and 53 % for 100. With a dozen samples, the samples that disagree may be a highlight.
[[nodiscard]] inline double largest_outlier_share(Eigen::Index n) noexcept {
  return n <= 12 ? 0.0 : 0.6 - 7.2 / static_cast<double>(n);
}

/// Returns the kept samples, each weight multiplied by the sample's inlier weight.
[[nodiscard]] located_samples weighted(const located_samples& samples, const inliers& found);

namespace detail {

/// Returns the samples that are inliers of two judgements.
[[nodiscard]] inliers inliers_of_both(inliers first, const inliers& second);

/// Returns the positions of the samples that are judged together. These are all samples if there are at most
/// `most_judged`; otherwise two thirds of `most_judged` are chosen at random and one third evenly from all
/// neighbourhoods of directions, so that a narrow highlight is represented. O(n log n) for n samples.
[[nodiscard]] std::vector<Eigen::Index> judged_together(const located_samples& samples);

[[nodiscard]] inline rgb first_three(const Eigen::MatrixXd& values, Eigen::Index row) {
  return {values(row, 0), values(row, 1), values(row, 2)};
}

/// The functions of a prior that the search uses, independent of the metric.
struct prior_functions {
  Eigen::MatrixXd coefficients;  ///< components x observations
  std::function<located_rows(std::span<const location>)> rows;
  std::function<located_samples(const located_samples&)> map;
  /// Adds the offset to mapped values and converts them to reflectance in sr^-1; a row for each location.
  std::function<void(std::span<const location>, Eigen::MatrixXd& values)> invert;
};

template <error_metric Metric>
[[nodiscard]] prior_functions functions_of(const pca<Metric>& prior, thread_count threads) {
  const Eigen::MatrixXf& observations = prior.coefficients();
  Eigen::MatrixXd coefficients(observations.cols(), observations.rows());
  for (Eigen::Index j = 0; j < coefficients.cols(); ++j)
    for (Eigen::Index k = 0; k < coefficients.rows(); ++k) coefficients(k, j) = double{observations(j, k)};
  return {std::move(coefficients), [&prior](std::span<const location> at) { return locate_rows(prior, at); },
          [&prior, threads](const located_samples& samples) { return map_samples(prior, samples, threads); },
          [&prior](std::span<const location> at, Eigen::MatrixXd& values) {
            for (Eigen::Index i = 0; i < values.rows(); ++i) {
              const double offset = offset_at(prior, at[i]);
              for (Eigen::Index j = 0; j < values.cols(); ++j)
                values(i, j) = reflectance_of(prior.metric(), values(i, j) + offset, at[i]);
            }
          }};
}

[[nodiscard]] inliers find_inliers(const prior_functions& prior, const expected_covariance& expected,
                                   const located_samples& samples, const located_samples& mapped,
                                   const Eigen::VectorXd& error_variances, const std::optional<sample_process>& all,
                                   thread_count threads);

}  // namespace detail

/// Finds the inliers among samples in three channels. `mapped` are the samples in the prior's domain (`map_samples`),
/// `error_variances` the variances of their errors. `all`, if given, is the process of all samples; it saves time if
/// there are at most `most_judged` samples. Costs `judge_samples` for j samples plus O(n j (j + k) + j m k), for n
/// samples, j of them judged together, k components and m observations of the prior.
template <error_metric Metric>
[[nodiscard]] inliers find_inliers(const pca<Metric>& prior, const expected_covariance& expected,
                                   const located_samples& samples, const located_samples& mapped,
                                   const Eigen::VectorXd& error_variances,
                                   const std::optional<sample_process>& all = {}, thread_count threads = {}) {
  return detail::find_inliers(detail::functions_of(prior, threads), expected, samples, mapped, error_variances, all,
                              threads);
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/inliers.ipp>
#endif
