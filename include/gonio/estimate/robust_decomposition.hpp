#pragma once
/// Components and a discrepancy for samples of which many may be outliers. The components are fitted again and again,
/// each time with the samples weighted by the probability that they are inliers (iteratively reweighted least squares,
/// Holland and Welsch 1977, doi:10.1080/03610927708827533, with the weights of outlier_mixture.hpp), from a start that
/// outliers cannot drag along. Results on real materials: docs/results/real-methods.md.

#include <gonio/core/random.hpp>
#include <gonio/estimate/discrepancy_decomposition.hpp>
#include <gonio/estimate/nearest_material.hpp>
#include <gonio/estimate/out_of_gamut.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/values_at.hpp>
#include <gonio/solve/product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

/// How `robust_decomposition` tells inliers from outliers.
struct robust_rounds {
  int rounds = 8;  ///< of weighting the samples and fitting the components again
  /// The start, the nearest material of the prior, looks at so many samples, chosen at random.
  Eigen::Index start_samples = 1500;
  std::uint64_t seed = 0;
};

/// The largest share of n samples that may be outliers: 60 %, less 7.2 samples. What disagrees with a dozen others may
/// as well be a highlight: of twelve samples none is called an outlier, of 20 at most 24 %, of 100 at most 53 %.
[[nodiscard]] inline double largest_outlier_share(Eigen::Index n) noexcept {
  return n <= 12 ? 0.0 : 0.6 - 7.2 / static_cast<double>(n);
}

/// Raises inlier weights, all by one factor and to 1 at most, until so many that no more than `largest_outlier_share`
/// are left count in full. O(n).
[[nodiscard]] Eigen::VectorXd limit_outliers(const Eigen::VectorXd& inlier_weights);

/// Components and discrepancy of the inliers. An `estimator`.
///
/// ```cpp
/// const gonio::robust_decomposition robust{gonio::discrepancy_decomposition{prior}};
/// const auto paint = robust.fit(samples);
/// ```
template <error_metric Metric>
class robust_decomposition {
 public:
  using basis_type = typename discrepancy_decomposition<Metric>::basis_type;

  explicit robust_decomposition(discrepancy_decomposition<Metric> estimator, const robust_rounds& options = {},
                                thread_count threads = {})
      : estimator_(std::move(estimator)), options_(options), threads_(threads) {}

  /// What each sample counts, from 0 (an outlier) to 1: n. For n samples, k components and m materials:
  /// O(rounds n k^2 + 1500 m k). Throws gonio::error if a solver gives up.
  [[nodiscard]] Eigen::VectorXd inlier_weights(const located_samples& given) const {
    const located_samples samples = out_of_gamut_as_xyz(given);
    const pca<Metric>& prior = estimator_.prior();
    const automatic_weights weighting{.down_weight_tail = false, .threads = threads_};
    const tikhonov solver(estimator_.observations() * estimator_.model().error_variance);
    const channel_values measured = samples.channels();
    const auto weigh = [&](const channel_values& estimated) {
      return limit_outliers(weighting.weigh(measured, estimated).row(0).transpose().template cast<double>());
    };
    Eigen::VectorXd weights = weigh(nearest(samples));
    for (int round = 0; round < options_.rounds; ++round) {
      const basis_equations equations(prior, weighted(samples, weights), threads_);
      weights =
          weigh(values_at(fitted_brdf(prior, equations.solve(solver)), prior.cells(), samples.locations, threads_));
    }
    return weights;
  }

  /// Samples that count as they did, times their inlier weights; outliers are left out.
  [[nodiscard]] static located_samples weighted(located_samples samples, const Eigen::VectorXd& inlier_weights) {
    constexpr double least_weight = 0.01;
    samples.weights.array().colwise() *= inlier_weights.array();
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < samples.size(); ++i)
      if (inlier_weights[i] >= least_weight) kept.push_back(i);
    return samples.subset(kept);
  }

  /// Throws gonio::error for unusable samples, or if a solver gives up.
  template <class Samples>
  [[nodiscard]] fitted_brdf<basis_type> fit(const Samples& samples) const {
    const located_samples located = locate_samples(estimator_.prior().cells(), samples, threads_);
    return estimator_.fit_located(weighted(located, inlier_weights(located)));
  }

 private:
  /// For each channel the material of the prior, brightened or darkened, under which the samples are most likely a
  /// mixture of inliers and outliers: its reflectance at them. As `nearest_material`, with no table expanded.
  [[nodiscard]] channel_values nearest(const located_samples& samples) const {
    const std::vector<Eigen::Index> chosen = random_choice(samples.size(), options_.start_samples, options_.seed);
    const located_samples some = samples.subset(chosen);
    const Eigen::MatrixXd materials =
        materials_at(some.locations, estimator_.prior().coefficients().template cast<double>());
    channel_values estimates(3, samples.size());
    for (Eigen::Index c = 0; c < 3; ++c) {
      // Find the likelihood of each material, each with its best factor.
      const double offset = logarithm_offset(samples.values.col(c));
      const Eigen::ArrayXd logarithms = (some.values.col(c).array().max(0.0) + offset).log();
      const outlier_density density({logarithms.begin(), logarithms.end()});
      const Eigen::ArrayXd outliers = logarithms.unaryExpr([&](double value) { return density(value); });
      std::vector<detail::scaled_likelihood> found(materials.cols());
      for_each_block(
          materials.cols(), 1,
          [&](block one) {
            const Eigen::ArrayXd differences = logarithms - (materials.col(one.begin).array() + offset).log();
            found[one.begin] = detail::best_factor(differences, outliers);
          },
          threads_);
      // Take the best one.
      const auto best = std::ranges::max_element(found, {}, &detail::scaled_likelihood::log_likelihood);
      const Eigen::MatrixXf coefficients = estimator_.prior().coefficients().row(best - found.begin());
      const Eigen::MatrixXd values = materials_at(samples.locations, coefficients.cast<double>());
      estimates.row(c) = (std::exp(best->logarithm_of_factor) * values).cast<float>().transpose();
    }
    return estimates;
  }

  /// The reflectance of materials, given their coefficients in rows, at locations: locations x materials.
  [[nodiscard]] Eigen::MatrixXd materials_at(const std::vector<location>& locations,
                                             const Eigen::MatrixXd& coefficients) const {
    const pca<Metric>& prior = estimator_.prior();
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
              values(range.begin + i, j) = std::max(prior.metric().inverse(mapped(i, j) + offset, at), 0.0);
          }
        },
        threads_);
    return values;
  }

  discrepancy_decomposition<Metric> estimator_;
  robust_rounds options_;
  thread_count threads_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/robust_decomposition.ipp>
#endif
