#pragma once
/// Which samples to fit: what `gonio reconstruct` does before it fits components and a discrepancy. Of few samples
/// those that the others contradict are left out; of many, outliers count less. The numbers of samples at which it
/// changes its ways were chosen on measured materials: docs/results/real-materials.md,
/// docs/decisions/0020-wrong-samples.md.

#include <gonio/estimate/outlying_samples.hpp>
#include <gonio/estimate/robust_decomposition.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <utility>
#include <vector>

namespace gonio {

/// Of fewer samples none is left out: one that disagrees may be the only one in the highlight.
inline constexpr Eigen::Index fewest_left_out = 13;
/// From so many samples on each is weighed, and none is named.
inline constexpr Eigen::Index fewest_weighed = 100;

/// Samples to fit, and what was found about all of those that were given.
struct screened_samples {
  located_samples kept;  ///< each counts as much as it is an inlier
  /// Those that count less than half, or not at all: positions, the worst first.
  std::vector<Eigen::Index> left_out = {};
  /// Those that the others contradict, the worst first; kept all the same if there are fewer than `fewest_left_out`
  /// samples, empty from `fewest_weighed` on.
  std::vector<outlying_sample> contradicted = {};
  double outlier_share = 0.0;  ///< of all samples; fractions of samples that count in part
  /// What each of those that were given counts, from 0 to 1: `kept` is what `robust_decomposition::weighted` makes of
  /// it.
  Eigen::VectorXd inlier_weights = {};
};

/// Costs what `reject_outlying` does, or `robust_decomposition::inlier_weights`. Throws gonio::error if the samples'
/// covariance is not positive definite, or if a solver gives up.
///
/// ```cpp
/// const auto screened = gonio::screen(estimator, gonio::locate_samples(prior.cells(), samples));
/// const auto paint = estimator.fit_located(screened.kept);
/// ```
template <error_metric Metric>
[[nodiscard]] screened_samples screen(const discrepancy_decomposition<Metric>& estimator,
                                      const located_samples& samples, thread_count threads = {}) {
  const auto n = static_cast<double>(samples.size());
  if (samples.size() < fewest_weighed) {
    sorted_samples sorted = reject_outlying(estimator, samples);
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(samples.size());
    if (samples.size() < fewest_left_out) return {samples, {}, std::move(sorted.left_out), 0.0, std::move(weights)};
    screened_samples found{samples.subset(sorted.kept), {}, std::move(sorted.left_out), 0.0, std::move(weights)};
    for (const outlying_sample& out : found.contradicted) {
      found.left_out.push_back(out.number);
      found.inlier_weights[out.number] = 0.0;
    }
    found.outlier_share = static_cast<double>(found.left_out.size()) / n;
    return found;
  }
  const robust_decomposition robust{estimator, {}, threads};
  Eigen::VectorXd weights = robust.inlier_weights(samples);
  screened_samples found{robust.weighted(samples, weights)};
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    if (weights[i] < 0.5) found.left_out.push_back(i);
  std::ranges::sort(found.left_out, {}, [&](Eigen::Index i) { return std::pair(weights[i], i); });
  found.outlier_share = 1.0 - weights.sum() / n;
  found.inlier_weights = std::move(weights);
  return found;
}

}  // namespace gonio
