#pragma once
/// The samples of one material as a Gaussian process: what a prior expects of them, and what they say of other
/// directions, of each other, and of how much the prior knows about them. Rasmussen and Williams, "Gaussian Processes
/// for Machine Learning", 2006, chapters 2 and 5. `reconstruction` is made of it; decision 19 says why its mean is the
/// ridge regression of Nielsen et al. 2015 (doi:10.1145/2816795.2818085, Eq. 12) and a discrepancy beside it.

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

/// What is assumed beside, where it is asked how sure a reconstruction is: what makes a mean hardly better, and an
/// interval true. Chosen on measured materials without their families, from samples all over, below a theta_h and in
/// planes: docs/decisions/0037-certainty-of-scans.md.
struct doubt_model {
  /// Of a material's deviation from its process that is known where samples are, and unknown far from all of them.
  double variance = 1.0;
  correlation_lengths lengths{0.13, 0.55, 1.1};
  /// Of errors that neighbouring samples share over the lengths of the discrepancy: many close together say no more
  /// than a few.
  double shared_error_variance = 0.005;
};

/// What is assumed of materials that a prior has not seen, in the squared units of its metric (natural logarithms of
/// `log_relative`). The defaults are those of least error on twenty measured materials of the RGL database, each
/// reconstructed by a prior without its family, at 5 to 500 measurements; choosing them anew for each material by the
/// marginal likelihood was worse there.
struct discrepancy_model {
  double variance = 0.02;         ///< of the discrepancy
  double error_variance = 0.007;  ///< of what is neither prior nor discrepancy, independent at each measurement
  correlation_lengths lengths = {};
  /// Added to the error variance where light or viewer graze; it falls by e with each 2.5 degrees above the horizon.
  double grazing_variance = 0.05;
  doubt_model doubt = {};
  double noise = 0.0;  ///< of the measurements, relative to them: 0.02 is 2 %
  /// Up to so many samples all is exact. Of more, so many chosen at random have a function of the discrepancy around
  /// them, which smooths it.
  Eigen::Index most_centres = 1000;
  /// So many samples, chosen at random, are fitted: beside at most 1,100 functions more of them change little.
  Eigen::Index most_samples = 200'000;
};

/// Falls from 1 where light or viewer graze by e with each `reach` in radians that both are above the horizon.
[[nodiscard]] double grazing_share(const half_difference& angles, double reach) noexcept;

/// The variance of an error at some angles, without noise.
[[nodiscard]] double error_variance_at(const discrepancy_model& model, const half_difference& angles) noexcept;

/// A prior's functions at n locations.
struct located_rows {
  Eigen::MatrixXd rows;                 ///< n x k
  std::vector<half_difference> angles;  ///< n

  [[nodiscard]] Eigen::Index size() const noexcept { return rows.rows(); }
};

template <basis Basis>
[[nodiscard]] located_rows locate_rows(const Basis& prior, std::span<const location> locations) {
  located_rows found{rows_at(prior, locations), {}};
  for (const location& at : locations) found.angles.push_back(at.angles);
  return found;
}

/// The covariance of a material's mapped reflectance before anything is measured, of each channel: with m observations
/// in the prior, its components' a(x) and a discrepancy, k(x, y) = a(x)'a(y) / m + variance k_d(x, y).
struct expected_covariance {
  double observations = 1.0;  ///< m
  discrepancy_model model;
  bool doubts = false;  ///< is the variance of `discrepancy_model::doubt` added?

  /// Of all pairs of n locations: n x n. O(n^2 k).
  [[nodiscard]] Eigen::MatrixXd among(const located_rows& all) const;
  /// Of p locations with n others: p x n. O(p n k).
  [[nodiscard]] Eigen::MatrixXd between(const located_rows& some, const located_rows& others) const;
};

/// What n samples are taken to be, in the metric's domain, from other samples.
struct sample_predictions {
  Eigen::MatrixXd mapped;     ///< n x channels: the samples themselves
  Eigen::MatrixXd mean;       ///< n x channels: what the others say
  Eigen::VectorXd deviation;  ///< n: standard deviation of the prediction and of the sample together

  /// The mean square, over the channels, of what a sample is off in deviations: about 1 if the model is right.
  [[nodiscard]] Eigen::VectorXd disagreement() const;
};

/// How well the materials of a prior explain some samples.
struct familiarity {
  /// y' K^-1 y / n of n samples, the mean over channels: about 1 for the materials of the prior.
  double scale = 1.0;
  /// F of n and 4 degrees of freedom: channels are taken to be fully correlated, and materials to differ in scale as
  /// those of docs/results/conformity.md do.
  double p_value = 1.0;
  /// Of y' K^-1 y: m |c|^2 of the components, the discrepancy's part, and that of the errors; together 1.
  double components = 0.0, discrepancy = 0.0, errors = 0.0;
};

/// What other locations are, given the samples.
struct process_prediction {
  Eigen::MatrixXd mean;        ///< p x channels, less the prior's mean
  Eigen::MatrixXd covariance;  ///< p x p, of each channel
};

/// n samples y, mapped and less the prior's mean, and their covariance K = k(X, X) + E with the variances E of their
/// errors. A value type whose copies share the covariance and what is made of it, each once and on demand. Every member
/// that needs K^-1 throws gonio::error if K is not positive definite.
class sample_process {
 public:
  /// So many samples are known before any is measured: the weight of the model's own variance beside that of the
  /// samples.
  static constexpr double known_before = 10.0;

  /// `mapped` has y as its values; a sample's weight divides the variance of its error, of which there is one for each
  /// sample. Where channels have weights of their own the mean weight counts, but for `fit`. O(n^2 k).
  sample_process(const expected_covariance& expected, located_rows at, const located_samples& mapped,
                 const Eigen::VectorXd& error_variances);

  [[nodiscard]] Eigen::Index size() const noexcept { return values_.rows(); }
  [[nodiscard]] Eigen::Index channels() const noexcept { return values_.cols(); }
  [[nodiscard]] const expected_covariance& expected() const noexcept { return shared_->expected; }
  /// The prior's functions at the samples.
  [[nodiscard]] const located_rows& at() const noexcept { return shared_->at; }
  /// y: n x channels.
  [[nodiscard]] const Eigen::MatrixXd& values() const noexcept { return values_; }
  /// K: n x n.
  [[nodiscard]] const Eigen::MatrixXd& covariance() const noexcept { return shared_->covariance; }
  /// K^-1: n x n. O(n^3) the first time.
  [[nodiscard]] const Eigen::MatrixXd& inverse() const;

  /// Other values of the same samples, n x any number of channels.
  [[nodiscard]] sample_process with_values(Eigen::MatrixXd values) const;
  /// The same samples with the doubts of the model (`doubt_model`) beside: how sure a fit is, is asked of it. O(n^2 k).
  [[nodiscard]] sample_process with_doubts() const;
  /// Some of the samples, by their positions, with a factor for the variance of each one's error. O(size^2).
  [[nodiscard]] sample_process subset(std::span<const Eigen::Index> positions,
                                      const Eigen::VectorXd& inlier_weights = {}) const;

  /// The weights of the prior's k components and then of n functions k_d(X, x), for each channel, whose combination is
  /// the mean of the process; the residual is weighted as `tikhonov` weights it, the KKT residual is that of K a = y.
  /// O(n^3 + n^2 channels).
  [[nodiscard]] solution fit() const;

  /// Each sample from all others: Eq. 5.10 to 5.12. O(n^3).
  [[nodiscard]] sample_predictions predicted_without() const;
  /// A row for each of some samples, from all others than these. O(n^3).
  [[nodiscard]] sample_predictions predicted_without(std::span<const Eigen::Index> positions) const;

  /// How badly the model explains the samples, s = (known_before + y' K^-1 y) / (known_before + n), the mean over
  /// channels: the scale of all variances, learned as the variance of normal numbers is.
  [[nodiscard]] double scale() const;
  /// The same of what is not error alone: of S = K - E, (known_before + y' K^-1 S K^-1 y) / (known_before + tr K^-1 S).
  /// Many smooth samples say that their errors are small, and nothing of what is far from them. O(n^3).
  [[nodiscard]] double scale_of_material() const;
  /// The standard deviation of the mapped value at one location, error included, for a scale of 1; `row` has k numbers.
  /// Eq. 2.26. O(n (n + k)).
  [[nodiscard]] double deviation(const Eigen::RowVectorXd& row, const half_difference& angles) const;
  /// The same before anything was measured. O(k).
  [[nodiscard]] double deviation_before(const Eigen::RowVectorXd& row, const half_difference& angles) const;
  /// Eq. 2.25 and 2.26, without errors and the scale. O(n^3 + p^2 n).
  [[nodiscard]] process_prediction predict(const located_rows& places, Eigen::MatrixXd covariance_before) const;

  /// Is this a material like those that the prior was learned from? O(n^3).
  [[nodiscard]] gonio::familiarity familiarity() const;

 private:
  struct stored {
    stored(expected_covariance model, located_rows rows, Eigen::MatrixXd weights, Eigen::VectorXd errors,
           Eigen::MatrixXd without_errors);

    expected_covariance expected;
    located_rows at;
    Eigen::MatrixXd sample_weights;   ///< n x 1, or n x channels
    Eigen::VectorXd error_variances;  ///< of a sample of weight 1
    Eigen::MatrixXd covariance;
    mutable std::once_flag factorised, inverted;
    mutable std::optional<cholesky> factors;
    mutable Eigen::MatrixXd inverse;
  };

  sample_process(std::shared_ptr<const stored> shared, Eigen::MatrixXd values);

  /// E on the diagonal, by the weights of one column of them, or by their mean.
  [[nodiscard]] static Eigen::VectorXd errors_of(const stored& parts, std::optional<Eigen::Index> column = {});
  [[nodiscard]] const cholesky& factors() const;

  std::shared_ptr<const stored> shared_;
  Eigen::MatrixXd values_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/sample_process.ipp>
#endif
