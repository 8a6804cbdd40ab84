#pragma once
/// The samples of one material as a Gaussian process (Rasmussen and Williams, "Gaussian Processes for Machine
/// Learning", 2006, chapters 2 and 5). Predicts other directions, and each sample from all other samples. Measures how
/// well the prior explains the samples. `reconstruction` uses it. Decision 19 explains why its mean is the ridge
/// regression of Nielsen et al. 2015 (doi:10.1145/2816795.2818085, Eq. 12) with a discrepancy added.

#include <gonio/basis/discrepancy.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace gonio {

/// Additional covariance for the uncertainty of a reconstruction. With it, the intervals contain the truth as often as
/// stated. The mean does not use it, because it would hardly improve the mean. Chosen on measured materials whose
/// families were left out of the prior, from samples over all directions, below a theta_h, in planes and in images:
/// docs/decisions/0037-certainty-of-scans.md.
struct doubt_model {
  /// Variance of a material's deviation from its process, `variance` (1 + `fresnel_weight` fresnel_rise(theta_d)). Only
  /// nearby samples determine this deviation. It grows and changes faster towards grazing theta_d, as Fresnel's
  /// reflectance does. The model's error variance grows by the same factor.
  double variance = 0.7, fresnel_weight = 3.0;
  correlation_lengths lengths{.theta_h = 0.13, .theta_d = 0.35, .azimuth = 1.1, .fresnel_weight = 1.0};
  /// Variance of errors that neighbouring samples share, with the correlation lengths of the discrepancy. Because of
  /// these errors, many close samples reduce the uncertainty hardly more than a few.
  double shared_error_variance = 0.005;
};

/// Assumptions about materials that are not in a prior. Variances are in the squared units of the prior's metric
/// (natural logarithms for `log_relative`). The defaults have the least error on twenty measured materials of the RGL
/// database, each reconstructed by a prior without its family, at 5 to 500 measurements. Choosing the variances for
/// each material by the marginal likelihood was worse.
struct discrepancy_model {
  double variance = 0.02;         ///< variance of the discrepancy
  double error_variance = 0.007;  ///< variance of all other errors, independent at each measurement
  correlation_lengths lengths = {};
  /// Additional error variance if light or viewer graze the surface. It falls by a factor of e for each 2.5 degrees
  /// that the lower of the two is above the horizon.
  double grazing_variance = 0.05;
  doubt_model doubt = {};
  double noise = 0.0;  ///< standard deviation of the measurements, relative to their values: 0.02 is 2 %
  /// The largest effective number of samples crowded at one theta_d, in fits of more than `most_centres` samples. The
  /// crowd of a sample is the number n of samples within 1.5 degrees of its theta_d, minus twice the number that there
  /// would be if theta_d was uniform. If n is larger than `effective_samples`, the sample's error variance is
  /// multiplied by n / `effective_samples`. Samples at one theta_d share errors: thousands of them in an image tell the
  /// components little more than a few hundred. docs/decisions/0037-certainty-of-scans.md.
  double effective_samples = 500.0;
  /// Up to this many samples, the process is exact. If there are more, only this many random samples are centres of the
  /// discrepancy's functions, which makes the discrepancy smoother.
  Eigen::Index most_centres = 1000;
  /// The largest number of samples to fit. If there are more, a random subset is fitted; more samples would hardly
  /// change a fit of at most 1,100 functions.
  Eigen::Index most_samples = 200'000;
};

/// Returns exp(-a / reach), where a is the angle in radians between the horizon and the lower of light and viewer.
[[nodiscard]] double grazing_share(const half_difference& angles, double reach) noexcept;

/// Returns the variance of a sample's error at some angles, without noise.
[[nodiscard]] double error_variance_at(const discrepancy_model& model, const half_difference& angles) noexcept;

/// Returns by how much the error variance of each sample grows because samples are crowded at one theta_d
/// (`discrepancy_model::effective_samples`). O(n log n) for n samples.
[[nodiscard]] Eigen::VectorXd crowding_variances(const discrepancy_model& model, std::span<const location> locations);

/// The k functions of a prior at n locations.
struct located_rows {
  Eigen::MatrixXd rows;                 ///< n x k
  std::vector<half_difference> angles;  ///< n

  [[nodiscard]] Eigen::Index size() const noexcept { return rows.rows(); }
};

/// Returns the functions of a prior at some locations. O(n k).
template <basis Basis>
[[nodiscard]] located_rows locate_rows(const Basis& prior, std::span<const location> locations) {
  located_rows found{rows_at(prior, locations), {}};
  for (const location& at : locations) found.angles.push_back(at.angles);
  return found;
}

/// The covariance of a material's mapped reflectance before any measurement, the same in each channel. For a prior of m
/// observations with components a(x), and a discrepancy with the correlation k_d, the covariance is k(x, y) = a(x)'a(y)
/// / m + variance k_d(x, y).
struct expected_covariance {
  double observations = 1.0;  ///< m
  discrepancy_model model;
  bool doubts = false;  ///< whether to add the variance of `discrepancy_model::doubt`

  /// Returns the covariance of all pairs of n locations: n x n. O(n^2 k) for k components.
  [[nodiscard]] Eigen::MatrixXd among(const located_rows& all) const;
  /// Returns the covariance of p locations with n other locations: p x n. O(p n k) for k components.
  [[nodiscard]] Eigen::MatrixXd between(const located_rows& some, const located_rows& others) const;
};

/// Predictions of n samples, each from other samples, in the metric's domain.
struct sample_predictions {
  Eigen::MatrixXd mapped;     ///< n x channels: the samples themselves
  Eigen::MatrixXd mean;       ///< n x channels: predicted from other samples
  Eigen::VectorXd deviation;  ///< n: combined standard deviation of prediction and sample

  /// Returns, for each sample, the squared prediction error in units of its variance, averaged over channels: about 1
  /// if the model is right.
  [[nodiscard]] Eigen::VectorXd disagreement() const;
};

/// How well the materials of a prior explain some samples.
struct familiarity {
  /// y' K^-1 y / n of n samples y with the covariance K, averaged over channels: about 1 for the materials of the
  /// prior.
  double scale = 1.0;
  /// The probability that a material like those of the prior has at least the observed scale, by the F distribution
  /// with n and 4 degrees of freedom. The p-value assumes that channels are fully correlated, and that the scales of
  /// materials vary as in docs/results/conformity.md.
  double p_value = 1.0;
  /// Shares of y' K^-1 y: of the components (m |c|^2), of the discrepancy, and of the errors. Their sum is 1.
  double components = 0.0, discrepancy = 0.0, errors = 0.0;
};

/// Predictions at p other locations, given the samples.
struct process_prediction {
  Eigen::MatrixXd mean;        ///< p x channels, without the prior's mean
  Eigen::MatrixXd covariance;  ///< p x p, of each channel
};

/// n samples y, mapped minus the prior's mean, at the locations X. The covariance of y is K = k(X, X) + E; the diagonal
/// matrix E has the variances of the samples' errors. A value type. Copies share the covariance, its factors and its
/// inverse, which are computed once, on demand. Every member that needs K^-1 throws gonio::error if K is not positive
/// definite.
class sample_process {
 public:
  /// When a scale is estimated, a scale of 1 counts as this many samples.
  static constexpr double known_before = 10.0;

  /// `mapped` has y as its values. The diagonal of E is `error_variances` divided by the samples' weights. If weights
  /// differ between channels, the mean over channels is used, except in `fit`. O(n^2 k) for k components.
  sample_process(const expected_covariance& expected, located_rows at, const located_samples& mapped,
                 const Eigen::VectorXd& error_variances);

  [[nodiscard]] Eigen::Index size() const noexcept { return values_.rows(); }
  [[nodiscard]] Eigen::Index channels() const noexcept { return values_.cols(); }
  [[nodiscard]] const expected_covariance& expected() const noexcept { return shared_->expected; }
  /// Returns the prior's functions at the samples.
  [[nodiscard]] const located_rows& at() const noexcept { return shared_->at; }
  /// Returns y: n x channels.
  [[nodiscard]] const Eigen::MatrixXd& values() const noexcept { return values_; }
  /// Returns K: n x n.
  [[nodiscard]] const Eigen::MatrixXd& covariance() const noexcept { return shared_->covariance; }
  /// Returns K^-1: n x n. O(n^3) the first time.
  [[nodiscard]] const Eigen::MatrixXd& inverse() const;

  /// Returns the same process with other values, n x any number of channels.
  [[nodiscard]] sample_process with_values(Eigen::MatrixXd values) const;
  /// Returns the process with the additional covariance of `doubt_model`, for computing uncertainty. O(n^2 k).
  [[nodiscard]] sample_process with_doubts() const;
  /// Returns the process of the samples at some positions. If given, `inlier_weights` (one for each sample of this
  /// process) multiply the samples' weights. O(positions^2).
  [[nodiscard]] sample_process subset(std::span<const Eigen::Index> positions,
                                      const Eigen::VectorXd& inlier_weights = {}) const;

  /// Returns the mean of the process as weights for each channel: the weights of the prior's k components, followed by
  /// those of the n functions k_d(X, x). The reported residual is weighted as in `tikhonov`. The KKT residual is the
  /// largest |y - K a| relative to the largest |y|, with the solution a of K a = y. O(n^3 + n^2 channels).
  [[nodiscard]] solution fit() const;

  /// Predicts each sample from all others: Eq. 5.10 to 5.12. O(n^3).
  [[nodiscard]] sample_predictions predicted_without() const;
  /// Predicts the samples at `positions`, one row each, from all other samples. O(n^3).
  [[nodiscard]] sample_predictions predicted_without(std::span<const Eigen::Index> positions) const;

  /// Returns the scale of all variances, s = (known_before + y' K^-1 y) / (known_before + n), averaged over channels.
  /// It is large if the model explains the samples badly.
  [[nodiscard]] double scale() const;
  /// Returns the scale of S = k(X, X), the covariance without any errors: (known_before + y' K^-1 S K^-1 y) /
  /// (known_before + tr K^-1 S). If many smooth samples show that their errors are small, `scale()` falls, but
  /// this scale does not: small errors say nothing about locations far from the samples. O(n^3).
  [[nodiscard]] double scale_of_material() const;
  /// Returns the standard deviations of the mapped values at p other locations, including the error of a measurement,
  /// for a scale of 1. Eq. 2.26. O(p n (n + k)).
  [[nodiscard]] Eigen::VectorXd deviations(const located_rows& others) const;
  /// Returns the same as `deviations`, but before any measurement. O(p k).
  [[nodiscard]] Eigen::VectorXd deviations_before(const located_rows& others) const;
  /// Predicts the values at p other locations, given their covariance before any measurement: Eq. 2.25 and 2.26,
  /// without errors of measurements and without the scale. O(n^3 + p^2 n).
  [[nodiscard]] process_prediction predict(const located_rows& others, Eigen::MatrixXd covariance_before) const;

  /// Returns how well the materials of the prior explain the samples. O(n^3).
  [[nodiscard]] gonio::familiarity familiarity() const;

 private:
  struct stored {
    stored(expected_covariance model, located_rows rows, Eigen::MatrixXd weights, Eigen::VectorXd errors,
           Eigen::MatrixXd without_errors);

    expected_covariance expected;
    located_rows at;
    Eigen::MatrixXd sample_weights;   ///< n x 1, or n x channels
    Eigen::VectorXd error_variances;  ///< error variances of samples of weight 1
    Eigen::MatrixXd covariance;
    mutable std::once_flag factorised, inverted;
    mutable std::optional<cholesky> factors;
    mutable Eigen::MatrixXd inverse;
  };

  sample_process(std::shared_ptr<const stored> shared, Eigen::MatrixXd values);

  /// Returns the diagonal of E, for the weights of one channel or for their mean over the channels.
  [[nodiscard]] static Eigen::VectorXd errors_of(const stored& parts, std::optional<Eigen::Index> column = {});
  [[nodiscard]] const cholesky& factors() const;

  std::shared_ptr<const stored> shared_;
  Eigen::MatrixXd values_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/sample_process.ipp>
#endif
