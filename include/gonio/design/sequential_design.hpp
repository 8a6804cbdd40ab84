#pragma once
/// Sequential experimental design: chooses the best next measurement, given the measurements already made. Scores each
/// candidate by the posterior covariance that the Gaussian process of `reconstruction` would have after measuring it,
/// for linear functions of the material: Cohn, Ghahramani and Jordan 1996, "Active learning with statistical models"
/// (doi:10.1613/jair.295); Rasmussen and Williams 2006, Eq. 2.24. Results: docs/results/adaptive-design.md.

#include <gonio/core/parallel.hpp>
#include <gonio/design/apparatus.hpp>
#include <gonio/design/capture_geometry.hpp>
#include <gonio/design/reading_variances.hpp>
#include <gonio/estimate/reconstruction.hpp>

#include <Eigen/Core>

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace gonio::design {

/// The sensitivity of p observed points, such as pixels, to the mapped values of the material at the candidates.
struct sensitivity {
  Eigen::MatrixXd slopes;   ///< 3 p x candidates: row 3 i + c is the derivative of channel c of point i
  Eigen::VectorXd weights;  ///< p: the weight of each point
};

/// Returns the weighted sum of the points' standard deviations: sum_i w_i (sum_c s_ic' P s_ic)^1/2 for the slopes s and
/// the covariance P of each channel. O(p candidates^2) for p points.
[[nodiscard]] double seen_deviation(const Eigen::MatrixXd& covariance, const sensitivity& seen,
                                    thread_count threads = {});

/// Returns one value for each candidate: `seen_deviation` after one more measurement at the candidate. A measurement at
/// x reduces P by P_x P_x' / (P_xx + error variance at x). O(p candidates^2) for p points. The bytes do not depend on
/// the number of threads.
[[nodiscard]] std::vector<double> seen_deviation_with_each(const Eigen::MatrixXd& covariance, const sensitivity& seen,
                                                           const Eigen::VectorXd& error_variances,
                                                           thread_count threads = {});

/// The posterior of the mapped values at all candidates.
struct candidate_posterior {
  Eigen::MatrixXd mean;        ///< candidates x 3
  Eigen::MatrixXd covariance;  ///< candidates x candidates, the same for each channel

  /// Updates the covariance for a measurement at a candidate. The covariance does not depend on the measured value.
  /// O(candidates^2).
  void add(Eigen::Index candidate, double error_variance);
};

/// Returns 3,246 cells: 24 of theta_h, 15 of theta_d and 12 of phi_d.
[[nodiscard]] valid_cells default_candidates();

/// The cells of a coarse grid as candidates, with the covariance at the cells according to an estimator's prior. A
/// value type; copies share the covariance, 8 bytes for each pair of candidates.
///
/// ```cpp
/// const gonio::reconstruction estimator{prior};
/// const gonio::design::sequential_design candidates(estimator);
/// const auto known = candidates.posterior_of(estimator.process_of(gonio::locate_samples(prior.cells(), samples)));
/// ```
template <error_metric Metric>
class sequential_design {
 public:
  /// O(candidates^2 k) for k components.
  explicit sequential_design(reconstruction<Metric> estimator, const apparatus& with = {},
                             valid_cells candidates = default_candidates())
      : estimator_(std::move(estimator)),
        geometry_(std::move(candidates), with.constraint),
        before_(std::make_shared<const expected>(estimator_, geometry_, with)) {}

  [[nodiscard]] const reconstruction<Metric>& estimator() const noexcept { return estimator_; }
  [[nodiscard]] const point_geometry& geometry() const noexcept { return geometry_; }
  /// The error variance of a measurement at each candidate: the variance of the estimator's model, which grows towards
  /// grazing angles, plus the variance of the apparatus.
  [[nodiscard]] const Eigen::VectorXd& error_variances() const noexcept { return before_->error_variances; }

  /// The locations of the candidates on the prior's cells, and the prior's functions and mean there.
  [[nodiscard]] const std::vector<location>& locations() const noexcept { return before_->locations; }
  [[nodiscard]] const located_rows& rows() const noexcept { return before_->at; }
  [[nodiscard]] const Eigen::VectorXd& offsets() const noexcept { return before_->offsets; }

  /// Returns the distribution before any measurement.
  [[nodiscard]] candidate_posterior prior() const { return {before_->offsets.replicate(1, 3), before_->covariance}; }

  /// Returns the posterior, given the process of n samples. O(n^3 + candidates^2 n).
  [[nodiscard]] candidate_posterior posterior_of(const sample_process& samples) const {
    auto [mean, covariance] = samples.predict(before_->at, before_->covariance);
    for (Eigen::Index c = 0; c < mean.cols(); ++c) mean.col(c) += before_->offsets;
    return {std::move(mean), std::move(covariance)};
  }

 private:
  struct expected {
    expected(const reconstruction<Metric>& estimator, const point_geometry& geometry, const apparatus& with)
        : offsets(geometry.size()) {
      for (Eigen::Index i = 0; i < geometry.size(); ++i) {
        locations.push_back(locate(estimator.prior().cells(), geometry.cells().angles(i)));
        offsets[i] = offset_at(estimator.prior(), locations.back());
      }
      at = locate_rows(estimator.prior(), locations);
      covariance = estimator.expected().among(at);
      error_variances = reading_variances(with, estimator.prior(), locations);
      for (Eigen::Index i = 0; i < geometry.size(); ++i)
        error_variances[i] += error_variance_at(estimator.model(), at.angles[i]);
    }

    located_rows at;          ///< the prior's functions at the candidates
    Eigen::VectorXd offsets;  ///< the prior's mean at the candidates
    std::vector<location> locations;
    Eigen::MatrixXd covariance;
    Eigen::VectorXd error_variances;
  };

  reconstruction<Metric> estimator_;
  point_geometry geometry_;
  std::shared_ptr<const expected> before_;
};

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/sequential_design.ipp>
#endif
