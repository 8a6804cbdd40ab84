#pragma once
/// Finds the samples of a material to keep, for any number of samples: those that their process does not call wrong
/// (wrong_samples.hpp). Of many samples, some are judged together, and each of the others by these. The search for
/// wrong samples also starts from the nearest material of the prior, which outliers cannot drag along. Reasons:
/// docs/decisions/0020-wrong-samples.md; results: docs/results/real-materials.md, docs/results/real-methods.md.

#include <gonio/basis/pca.hpp>
#include <gonio/estimate/map_samples.hpp>
#include <gonio/estimate/sample_process.hpp>
#include <gonio/estimate/wrong_samples.hpp>

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

/// The largest number of samples that are judged together, by one process of all of them.
inline constexpr Eigen::Index most_judged = 500;
/// The largest number of contradicted samples for which the prediction by the others is reported.
inline constexpr Eigen::Index most_contradicted = 20;

/// A sample that the others contradict, for reports.
struct outlying_sample {
  Eigen::Index number = 0;   ///< its position among the samples
  rgb measured;              ///< sr^-1
  rgb predicted;             ///< sr^-1, from all samples that are not contradicted
  double deviation = 0.0;    ///< of the prediction, in the metric's domain: relative where that is a logarithm
  double probability = 0.0;  ///< that the sample is wrong

  /// Returns the channel in which measured and predicted value differ by the largest factor. A negative value counts as
  /// zero, and 0.001 sr^-1 is added to both.
  [[nodiscard]] Eigen::Index worst_channel() const;
};

/// The inliers among n samples.
struct inliers {
  Eigen::VectorXd weights;             ///< the probability that each sample is right
  std::vector<Eigen::Index> rejected;  ///< positions of samples with a weight below one half, the worst first
  /// The first `most_contradicted` of these that were judged together, with the prediction by the others.
  std::vector<outlying_sample> contradicted = {};
  double outlier_share = 0.0;  ///< the mean of 1 - weight over all samples

  /// Returns the positions of the samples whose weight is at least 0.01.
  [[nodiscard]] std::vector<Eigen::Index> kept() const;
};

/// Returns n samples as inliers.
[[nodiscard]] inliers all_inliers(Eigen::Index n);

/// Returns the largest share of n samples that a count of outliers may state: 60 % minus 7.2 samples. Samples that
/// disagree with a dozen others may be a highlight. The share is 0 for 12 samples, 24 % for 20, 53 % for 100.
[[nodiscard]] inline double largest_outlier_share(Eigen::Index n) noexcept {
  return n <= 12 ? 0.0 : 0.6 - 7.2 / static_cast<double>(n);
}

/// Returns the kept samples, with their weights multiplied by the inlier weights.
[[nodiscard]] located_samples weighted(const located_samples& samples, const inliers& found);

namespace detail {

/// Returns the positions of the samples that are judged together: all of up to `most_judged`. Of more samples, two
/// thirds of `most_judged` are chosen at random and one third evenly from all neighbourhoods, so that a narrow
/// highlight is represented. O(n log n).
[[nodiscard]] std::vector<Eigen::Index> judged_together(const located_samples& samples);

/// Returns the first three numbers of a row.
[[nodiscard]] inline rgb first_three(const Eigen::MatrixXd& values, Eigen::Index row) {
  return {values(row, 0), values(row, 1), values(row, 2)};
}

/// The functions of a prior that the search uses, independent of the metric.
struct prior_functions {
  Eigen::MatrixXd coefficients;  ///< components x observations
  std::function<located_rows(std::span<const location>)> rows;
  std::function<located_samples(const located_samples&)> map;
  /// Converts mapped values without the offset to reflectance in sr^-1: a row for each location.
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

/// Finds the inliers among samples in colours. `mapped` are the samples in the prior's domain (`map_samples`),
/// `error_variances` the variances of their errors. `all`, if given, is the process of all samples and is used for up
/// to `most_judged` of them. For n samples, j of them judged together, k components and m materials: the cost of
/// `judge_samples` for j, plus O(n j (j + k)) and O(j m k).
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
