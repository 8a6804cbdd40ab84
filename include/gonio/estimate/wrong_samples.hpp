#pragma once
/// Which samples of a process are wrong: disagreement that neighbours share is the material, isolated disagreement is
/// an error. A sample is an inlier, or has an error of large variance (mixtures of good and bad observations: Box and
/// Tiao 1968, doi:10.1093/biomet/55.1.119). Beside the process stand deviations that neighbouring samples have in
/// common, near the highlight or everywhere, whose variances are chosen by the samples' likelihood (Rasmussen and
/// Williams, "Gaussian Processes for Machine Learning", 2006, section 5.4.1). The constants were chosen on measured
/// materials and on in-plane scans of synthetic highlights: docs/decisions/0020-wrong-samples.md.

#include <gonio/estimate/sample_process.hpp>

#include <Eigen/Core>

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

/// Deviations of a material that are no error, in the squared units of the metric (natural logarithms): variances of
/// what a material's channels have in common. A tenth of each is allowed to each contrast of the channels.
struct shared_deviation {
  double everywhere = 0.0;
  double in_highlight = 0.0;  ///< at theta_h = 0; a quarter of it at `rejection_rule::highlight_reach`
};

/// What is expected of wrong samples, and of those that are not.
struct rejection_rule {
  /// Of the share of wrong samples, whose distribution is Beta(expected_number, 1): of n samples, one is taken to be
  /// wrong with the odds expected_number / n, and the others the sooner the more are wrong already.
  double expected_number = 0.2;
  /// Standard deviations of a wrong sample's error in the metric's domain: of what its channels have in common (where
  /// that is a logarithm, 1.7 is a factor of 5), and of each channel beside.
  double common_error = 1.7, channel_error = 0.3;

  /// Of the error of the channels' mean, times sqrt(3), and of each of their contrasts.
  [[nodiscard]] double mean_variance() const noexcept {
    return 3.0 * common_error * common_error + contrast_variance();
  }
  [[nodiscard]] double contrast_variance() const noexcept { return channel_error * channel_error; }

  /// Of the samples are rejected at most, and at least one.
  double largest_share = 0.6;

  /// Of a shared deviation: its variances, from small to large, and by how much the logarithm of the probability falls
  /// with each step.
  std::vector<double> everywhere{0.1, 1.0}, in_highlight{0.3, 3.0};
  double everywhere_penalty = 6.0, highlight_penalty = 3.0;
  correlation_lengths everywhere_lengths{0.05, 0.2, 0.4}, highlight_lengths{0.05, 0.5, 1.0};
  double highlight_reach = radians(4.0);  ///< theta_h
  /// Variance of what a material deviates where light or viewer graze, from sample to sample, shared by the channels;
  /// it falls by e with each `grazing_reach` that both are above the horizon.
  double grazing_variance = 0.36, grazing_reach = radians(2.5);
};

struct wrong_sample {
  Eigen::Index number = 0;   ///< its position among the samples
  double probability = 0.0;  ///< that it is wrong
};

/// What was found about the samples of a process, and what it says of others.
class judged_samples {
 public:
  /// The most probable set of wrong samples that a search finds; the least doubtful first.
  [[nodiscard]] const std::vector<wrong_sample>& wrong() const noexcept { return wrong_; }
  /// Of each sample, that it is wrong, if all others are what the set says.
  [[nodiscard]] const Eigen::VectorXd& probabilities() const noexcept { return probabilities_; }
  /// The deviations that the samples were found to share.
  [[nodiscard]] const shared_deviation& shared() const noexcept { return shared_; }

  /// The same of p other samples of the material, each by itself; `mapped` and `error_variances` are theirs. O(p n (n +
  /// k)).
  [[nodiscard]] Eigen::VectorXd probabilities(const located_rows& others, const Eigen::MatrixXd& mapped,
                                              const Eigen::VectorXd& error_variances) const;

 private:
  friend judged_samples judge_samples(const sample_process& samples, const rejection_rule& rule,
                                      std::span<const std::vector<bool>> starts);

  std::vector<wrong_sample> wrong_;
  Eigen::VectorXd probabilities_;
  shared_deviation shared_;
  rejection_rule rule_;
  expected_covariance expected_;
  located_rows at_;
  Eigen::MatrixXd values_;                    ///< the mean of the channels, and their contrasts
  std::optional<cholesky> mean_, contrasts_;  ///< factors of their covariances
  double scale_ = 1.0, log_odds_ = 0.0;
};

/// Judges the samples of a process, each in three channels. The search starts without wrong samples, and from each of
/// `starts`, and changes the side of one sample, or of two, as long as that makes the whole more probable, the scale of
/// all variances unknown. O(n^3 + n^2 rejected) for each start and each variance of the rule's. Throws gonio::error for
/// an impossible rule.
[[nodiscard]] judged_samples judge_samples(const sample_process& samples, const rejection_rule& rule = {},
                                           std::span<const std::vector<bool>> starts = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/wrong_samples.ipp>
#endif
