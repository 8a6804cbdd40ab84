#pragma once
/// Samples that disagree with the others: each is predicted from all others, by the prior and its discrepancy, in
/// closed form. Leave-one-out of a Gaussian process: Rasmussen and Williams, "Gaussian Processes for Machine Learning",
/// 2006, section 5.4.2, Eq. 5.10-5.12. For few samples; of thousands `robust_reconstruction` weighs each.

#include <gonio/estimate/discrepancy_decomposition.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/out_of_gamut.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace gonio {

/// What the other samples say of each of n, in the metric's domain.
struct left_out_predictions {
  Eigen::MatrixXd mapped;     ///< n x 3: the samples themselves
  Eigen::MatrixXd mean;       ///< n x 3: each as predicted from all others
  Eigen::VectorXd deviation;  ///< n: standard deviation of the prediction and of the sample together

  /// The mean square, over the channels, of what a sample is off in deviations: about 1 if the model is right.
  [[nodiscard]] Eigen::VectorXd disagreement() const {
    return (mapped - mean).rowwise().squaredNorm().array() / deviation.array().square() /
           static_cast<double>(mapped.cols());
  }
};

/// Given the covariance of the samples, errors included, n x n, and their mapped values less the prior's mean, n x 3.
/// Throws gonio::error if the covariance is not positive definite. O(n^3).
[[nodiscard]] left_out_predictions predict_left_out(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& values);

/// A sample that was left out, for people: which of the samples that count, and the others' prediction.
struct outlying_sample {
  Eigen::Index number = 0;   ///< its position among the located samples
  rgb measured;              ///< sr^-1
  rgb predicted;             ///< sr^-1, from those that were kept
  double deviation = 0.0;    ///< of the prediction, in the metric's domain: relative where that is a logarithm
  double probability = 0.0;  ///< that the sample is wrong
};

/// What is expected of wrong samples, and when one is left out. The defaults were chosen on measured materials, with
/// two wrong of twenty and with none (docs/results/real-materials.md).
struct rejection_rule {
  double expected_number = 0.2;  ///< of wrong samples among all; of one sample in two at most
  /// Standard deviations of a wrong sample's error in the metric's domain: of what its channels have in common (where
  /// that is a logarithm, 1.7 is a factor of 5), and of each channel beside.
  double common_error = 1.7, channel_error = 0.3;
  double least_probability = 0.75;  ///< of being wrong, for a sample to be left out
  double largest_share = 0.2;       ///< of the samples are left out at most, and at least one
};

/// Which of the samples that count were kept, and which were left out, the worst first.
struct sorted_samples {
  std::vector<Eigen::Index> kept;
  std::vector<outlying_sample> left_out;
};

namespace detail {

struct wrong_sample {
  Eigen::Index number = 0;
  double probability = 0.0;
};

/// The set of wrong samples of the largest probability that a search finds, without those below the rule's least; the
/// most probable first. `covariance` is that of all samples.
[[nodiscard]] std::vector<wrong_sample> find_wrong_samples(const Eigen::MatrixXd& covariance,
                                                           const Eigen::MatrixXd& values, const rejection_rule& rule);

/// A row of predictions for each of some samples from all others than these.
[[nodiscard]] left_out_predictions predict_from_others(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& values,
                                                       const std::vector<Eigen::Index>& left_out);

}  // namespace detail

/// Sorts samples by whether the rest of them, the prior and its discrepancy can explain them. A wrong sample has an
/// error of large variance. Sets of wrong samples are compared by their probability given all samples, the scale of all
/// variances unknown: where the model is poor all samples disagree a little, and none is an outlier. Mixtures of good
/// and bad observations: Box and Tiao 1968 (doi:10.1093/biomet/55.1.119). O(n^3 + n^2 (k + left out)). Throws
/// gonio::error for more than 5,000 samples.
///
/// ```cpp
/// const auto located = gonio::locate_samples(prior.cells(), samples);
/// const auto sorted = gonio::reject_outlying(gonio::discrepancy_decomposition{prior}, located);
/// const auto paint = gonio::discrepancy_decomposition{prior}.fit_located(located.subset(sorted.kept));
/// ```
template <error_metric Metric>
[[nodiscard]] sorted_samples reject_outlying(const discrepancy_decomposition<Metric>& estimator,
                                             const located_samples& samples, const rejection_rule& rule = {}) {
  constexpr Eigen::Index most_samples = 5000;
  if (samples.size() > most_samples)
    refuse({"outlying samples are sought among at most ", most_samples, ", not among ", samples.size()});
  const auto& metric = estimator.prior().metric();
  const Eigen::MatrixXd covariance = estimator.covariance(samples);
  const std::vector<detail::wrong_sample> wrong =
      detail::find_wrong_samples(covariance, estimator.mapped_values(out_of_gamut_as_xyz(samples)), rule);

  // Say what those that were kept make of those that were not.
  std::vector<bool> rejected(samples.size(), false);
  std::vector<Eigen::Index> numbers;
  for (const detail::wrong_sample& sample : wrong) {
    rejected[sample.number] = true;
    numbers.push_back(sample.number);
  }
  const left_out_predictions others =
      detail::predict_from_others(covariance, estimator.mapped_values(samples), numbers);
  sorted_samples sorted;
  for (Eigen::Index i = 0; i < samples.size(); ++i)
    if (!rejected[i]) sorted.kept.push_back(i);
  for (Eigen::Index i = 0; i < std::ssize(wrong); ++i) {
    const Eigen::Index number = wrong[i].number;
    const location& at = samples.locations[number];
    const double offset = offset_at(estimator.prior(), at);
    outlying_sample out{.number = number,
                        .measured = samples.values.row(number).head<3>().transpose().array(),
                        .predicted = rgb::Zero(),
                        .deviation = others.deviation[i],
                        .probability = wrong[i].probability};
    for (Eigen::Index c = 0; c < 3; ++c)
      out.predicted[c] = std::max(metric.inverse(others.mean(i, c) + offset, at), 0.0);
    sorted.left_out.push_back(out);
  }
  return sorted;
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/outlying_samples.ipp>
#endif
