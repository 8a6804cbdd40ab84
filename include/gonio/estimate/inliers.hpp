#pragma once
/// Which samples of a material to believe, at any number of them: those that their process does not call wrong
/// (wrong_samples.hpp). Of many samples some are judged together, and each of the others by these. The search for wrong
/// samples starts from what the nearest material of the prior says, too, which outliers cannot drag along. Why so:
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

/// At most so many samples are judged together, by a process of all of them.
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

  /// The channel in which reading and prediction differ by the largest factor; a negative value counts as zero, and
  /// 0.001 sr^-1 is added to both.
  [[nodiscard]] Eigen::Index worst_channel() const;
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

/// The positions of those samples that are judged together: all of up to `most_judged`. Of more, two thirds of so many
/// are chosen at random, and a third from all neighbourhoods alike, so that a narrow highlight has its samples among
/// them. O(n log n).
[[nodiscard]] std::vector<Eigen::Index> judged_together(const located_samples& samples);

/// The first three numbers of a row.
[[nodiscard]] inline rgb first_three(const Eigen::MatrixXd& values, Eigen::Index row) {
  return {values(row, 0), values(row, 1), values(row, 2)};
}

/// What the search asks a prior, whatever its metric.
struct prior_functions {
  Eigen::MatrixXd coefficients;  ///< components x observations
  std::function<located_rows(std::span<const location>)> rows;
  std::function<located_samples(const located_samples&)> map;
  /// Makes reflectance, sr^-1, of mapped values less the offset: a row for each location.
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

/// The inliers of samples in colours: `mapped` are the same in the prior's domain (`map_samples`), `error_variances`
/// those of each one's error. `all` is the process of all of them, if there is one: it is used for up to `most_judged`.
/// For n samples, j of them judged together, k components and m materials: what `judge_samples` does for j, O(n j (j +
/// k)), and O(j m k).
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
