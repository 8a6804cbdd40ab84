#pragma once
/// Finds the wrong samples of a process. Disagreement that neighbours share belongs to the material; isolated
/// disagreement is an error. Brightness and colour are judged separately, because an error of a single channel mainly
/// changes the colour. Each either is right or has an error of large variance (Box and Tiao 1968,
/// doi:10.1093/biomet/55.1.119). The covariance of the process includes deviations that neighbouring samples share,
/// near the highlight or everywhere. The variances of these deviations maximise the likelihood of the samples
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
/// logarithms), at a scale of 1 (`property_rule::scale`).
struct shared_deviation {
  double everywhere = 0.0;
  double in_highlight = 0.0;  ///< at theta_h = 0; at `rejection_rule::highlight_reach`, a quarter of this variance
};

/// Assumptions about one property of the samples: brightness or colour.
struct property_rule {
  /// Variance of a wrong sample's error in the metric's domain. The standard deviation 1.7 of the brightness is a
  /// factor of 5.5 if the metric is a logarithm.
  double error_variance = 2.9;
  /// The scale of all variances of right samples is unknown. Its inverse gamma distribution for n samples has the mean
  /// `scale` and `degrees` + n `degrees_per_sample` degrees of freedom.
  double scale = 1.0, degrees = sample_process::known_before, degrees_per_sample = 1.0;
};

/// Assumptions about wrong samples and about right samples.
struct rejection_rule {
  /// The fraction of wrong samples has the distribution Beta(expected_number, 1), and each wrong sample lowers the
  /// log-probability by `penalty`. The odds that a sample is wrong are exp(-penalty) (expected_number + w) / (n - w) if
  /// w of n samples are already in the set of wrong samples.
  double expected_number = 0.2, penalty = 1.2;
  /// The brightness is the mean of the channels. The colour is two orthonormal contrasts between them, whose
  /// log-likelihoods are averaged because the contrasts of a material are alike. The colours of a material deviate less
  /// than its brightness; the ratio differs from one material to another.
  property_rule brightness{};
  property_rule colour{.error_variance = 1.0, .scale = 0.3, .degrees_per_sample = 0.1};

  /// The largest fraction of samples that the search calls wrong. The search may always call one sample wrong, but none
  /// if there are fewer than three samples.
  double largest_share = 0.6;

  /// The variances of a shared deviation that are tried after 0, ascending. Each step to the next variance lowers the
  /// log-probability by the penalty.
  std::vector<double> everywhere{0.1, 1.0}, in_highlight{0.3, 3.0};
  double everywhere_penalty = 6.0, highlight_penalty = 3.0;
  correlation_lengths everywhere_lengths{0.05, 0.2, 0.4}, highlight_lengths{0.05, 0.5, 1.0};
  double highlight_reach = radians(4.0);  ///< theta_h
  /// Variance of the independent deviations of right samples with grazing light or viewer. It falls by a factor of e
  /// for each `grazing_reach` in radians above the horizon (`grazing_share`).
  double grazing_variance = 0.36, grazing_reach = radians(2.5);
};

struct wrong_sample {
  Eigen::Index number = 0;   ///< position of the sample among those of the process
  double probability = 0.0;  ///< probability that the sample is wrong
};

/// The result of judging the samples of a process: which are wrong. It can also judge other samples of the material.
class judged_samples {
 public:
  /// Returns the samples whose brightness or colour is wrong with a probability above one half, the most certainly
  /// wrong first.
  [[nodiscard]] const std::vector<wrong_sample>& wrong() const noexcept { return wrong_; }
  /// Returns the probability that each sample is wrong, assuming that the sets which the search found are right about
  /// all other samples. The probability is one half for samples in excess of `rejection_rule::largest_share`.
  [[nodiscard]] const Eigen::VectorXd& probabilities() const noexcept { return probabilities_; }
  /// Returns the variances of the deviations that the samples share in brightness.
  [[nodiscard]] shared_deviation shared() const { return brightness_ ? brightness_->shared : shared_deviation{}; }

  /// Returns the probabilities that p other samples of the material are wrong, each judged separately. `mapped` and
  /// `error_variances` are those of the other samples. O(p n (n + k)) for n samples of the process and k components.
  [[nodiscard]] Eigen::VectorXd probabilities(const located_rows& others, const Eigen::MatrixXd& mapped,
                                              const Eigen::VectorXd& error_variances) const;

 private:
  friend judged_samples judge_samples(const sample_process& samples, const rejection_rule& rule,
                                      std::span<const std::vector<bool>> starts);

  /// A property of the judged samples, with the data for judging other samples by this property.
  struct judged_property {
    property_rule rule;
    Eigen::MatrixXd values;    ///< n x 1 or n x 2
    Eigen::VectorXd log_odds;  ///< that the property of each sample is wrong
    cholesky factors;          ///< of the covariance
    shared_deviation shared;
    double scale = 1.0, prior_log_odds = 0.0;
  };

  /// Returns the logarithm of the odds that a property of each of some other samples is wrong. `covariance` has the
  /// covariance of the judged samples with the others.
  [[nodiscard]] Eigen::VectorXd log_odds(const judged_property& known, const located_rows& others,
                                         const Eigen::MatrixXd& values, const Eigen::VectorXd& error_variances,
                                         const Eigen::MatrixXd& covariance) const;

  std::vector<wrong_sample> wrong_;
  Eigen::VectorXd probabilities_;
  rejection_rule rule_;
  expected_covariance expected_;
  located_rows at_;
  std::optional<judged_property> brightness_, colour_;  ///< none if the property was not judged
};

/// Judges the samples of a process, each in three channels. Grey samples are judged by their brightness alone. The
/// search starts from an empty set of wrong samples, and from each set of `starts` (true for a wrong sample). It adds
/// or removes one sample, or adds two, while that raises the probability of the set. O(n^3 + n^2 wrong samples) for
/// each property, each start and each variance of the rule, for n samples. Throws gonio::error for an impossible rule.
[[nodiscard]] judged_samples judge_samples(const sample_process& samples, const rejection_rule& rule = {},
                                           std::span<const std::vector<bool>> starts = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/wrong_samples.ipp>
#endif
