#pragma once
/// Finds the wrong samples of a process. Disagreement that neighbours share belongs to the material; isolated
/// disagreement is an error. A sample is an inlier, or has an error of large variance (mixtures of good and bad
/// observations: Box and Tiao 1968, doi:10.1093/biomet/55.1.119). The process is extended by deviations that
/// neighbouring samples share, near the highlight or everywhere; the samples' likelihood chooses their variances
/// (Rasmussen and Williams, "Gaussian Processes for Machine Learning", 2006, section 5.4.1). The constants were chosen
/// on measured materials and in-plane scans of synthetic highlights: docs/decisions/0020-wrong-samples.md.

#include <gonio/estimate/sample_process.hpp>

#include <Eigen/Core>

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

/// Variances of deviations that belong to the material and not to errors, in the squared units of the metric (natural
/// logarithms). They are variances of the channels' common part; each contrast of the channels has a tenth of them.
struct shared_deviation {
  double everywhere = 0.0;
  double in_highlight = 0.0;  ///< at theta_h = 0; a quarter of it at `rejection_rule::highlight_reach`
};

/// Expected properties of wrong samples, and of right ones.
struct rejection_rule {
  /// The share of wrong samples has the distribution Beta(expected_number, 1). The odds that one of n samples is wrong
  /// are about expected_number / n, and grow with the number of samples already called wrong.
  double expected_number = 0.2;
  /// Standard deviations of a wrong sample's error in the metric's domain: of the channels' common part (1.7 is a
  /// factor of 5 if the metric is a logarithm), and of each channel in addition.
  double common_error = 1.7, channel_error = 0.3;

  /// Variances of a wrong sample's error: in the mean of the channels times sqrt(3), and in each of their contrasts.
  [[nodiscard]] double mean_variance() const noexcept {
    return 3.0 * common_error * common_error + contrast_variance();
  }
  [[nodiscard]] double contrast_variance() const noexcept { return channel_error * channel_error; }

  /// The largest share of samples that is rejected; one sample may always be.
  double largest_share = 0.6;

  /// The variances of a shared deviation that are tried, ascending. Each step lowers the logarithm of the probability
  /// by the penalty.
  std::vector<double> everywhere{0.1, 1.0}, in_highlight{0.3, 3.0};
  double everywhere_penalty = 6.0, highlight_penalty = 3.0;
  correlation_lengths everywhere_lengths{0.05, 0.2, 0.4}, highlight_lengths{0.05, 0.5, 1.0};
  double highlight_reach = radians(4.0);  ///< theta_h
  /// Variance by which a material deviates from sample to sample if light or viewer graze, shared by the channels. It
  /// falls by a factor of e for each `grazing_reach` that both are above the horizon.
  double grazing_variance = 0.36, grazing_reach = radians(2.5);
};

struct wrong_sample {
  Eigen::Index number = 0;   ///< its position among the samples
  double probability = 0.0;  ///< that it is wrong
};

/// The judgement of a process' samples. Also judges other samples.
class judged_samples {
 public:
  /// Returns the most probable set of wrong samples that the search found, the most certain first.
  [[nodiscard]] const std::vector<wrong_sample>& wrong() const noexcept { return wrong_; }
  /// Returns for each sample the probability that it is wrong, if all others are as in the set.
  [[nodiscard]] const Eigen::VectorXd& probabilities() const noexcept { return probabilities_; }
  /// Returns the deviations that the samples share.
  [[nodiscard]] const shared_deviation& shared() const noexcept { return shared_; }

  /// Returns the probabilities that p other samples of the material are wrong, each judged separately. `mapped` and
  /// `error_variances` are those of the other samples. O(p n (n + k)).
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
  Eigen::MatrixXd values_;                    ///< the mean of the channels times sqrt(3), and their contrasts
  std::optional<cholesky> mean_, contrasts_;  ///< factors of their covariances
  double scale_ = 1.0, log_odds_ = 0.0;
};

/// Judges the samples of a process, each in three channels. The search starts without wrong samples, and from each of
/// `starts`. It changes the side of one sample, or of two, while that raises the probability of the whole set; the
/// scale of all variances is unknown. O(n^3 + n^2 rejected) for each start and each variance of the rule. Throws
/// gonio::error for an impossible rule.
[[nodiscard]] judged_samples judge_samples(const sample_process& samples, const rejection_rule& rule = {},
                                           std::span<const std::vector<bool>> starts = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/wrong_samples.ipp>
#endif
