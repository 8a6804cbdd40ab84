#pragma once
/// How sure an estimate by prior and discrepancy is: the posterior of the Gaussian process that it is the mean of.
/// Rasmussen and Williams, "Gaussian Processes for Machine Learning", 2006, Eq. 2.24. Its scale is learned from the
/// samples, as the variance of normal numbers is; how often the intervals hold on measured materials whose families the
/// prior has not seen: docs/results/real-materials.md.

#include <gonio/core/statistics.hpp>
#include <gonio/estimate/discrepancy_decomposition.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace gonio {

/// A reflectance with this probability lies between two values, sr^-1.
struct reflectance_interval {
  rgb low, high;
};

/// Probabilities that intervals are offered for.
enum class confidence_level { sixty_eight_percent, ninety_five_percent };

/// To how many of the model's deviations an interval reaches, given the number of samples: a curve through the
/// conformal factors of measured materials, the quantiles of their errors in such deviations (Lee, Barber and Willett
/// 2023, doi:10.48550/arXiv.2306.06342). With the factors of other families than its own, a material's intervals hold
/// 67 to 68 and 94 to 95 % of its values in the mean. A promise for materials like those, in the mean over directions.
[[nodiscard]] inline double deviations_of(confidence_level level, Eigen::Index samples) noexcept {
  const auto n = static_cast<double>(std::max<Eigen::Index>(samples, 1));
  const double few = std::exp(-n / 10.0);
  // Of more than 500 samples the posterior knows 500; what the estimate gains by the others was measured to 20,000.
  const double many = std::pow(std::clamp(500.0 / n, 1.0 / 40.0, 1.0), 1.0 / 7.0);
  return many * (level == confidence_level::sixty_eight_percent ? 0.56 + 0.5 * few : 1.97 + 0.75 * few);
}

/// The deviations of an estimate, given where was measured and what. A value type whose copies share what they hold.
///
/// With the covariance K of the samples and k(x) of a place with them, the variance of the mapped value there is
/// s (k(x, x) + error_variance - k(x)' K^-1 k(x)). The scale s tells how badly the model explains the samples y,
/// s = (10 + y' K^-1 y) / (10 + n), the mean over channels: the ten are what is known before.
template <error_metric Metric>
class posterior {
 public:
  /// Of more samples, so many at random are looked at: what more of them know is left out, deviations are too large.
  static constexpr Eigen::Index most_samples = 500;

  /// O(n^2 (n + k)) for n samples and k components. Throws gonio::error for samples that cannot be.
  posterior(discrepancy_decomposition<Metric> estimator, const located_samples& samples)
      : estimator_(std::move(estimator)),
        samples_(samples.size()),
        shared_(std::make_shared<const stored>(estimator_, some_of(samples))) {}

  /// Of all mapped values relative to what the prior, the discrepancy and the errors were expected to be.
  [[nodiscard]] double scale() const noexcept { return shared_->scale; }

  /// The standard deviation of a value in the metric's domain; where that is a logarithm, relative to the value. O(n (n
  /// + k)).
  [[nodiscard]] double deviation(const location& at) const {
    const Eigen::RowVectorXd row = row_at(estimator_.prior(), at);
    const double observations = estimator_.observations();
    Eigen::VectorXd with = product(shared_->rows, row.transpose()) / observations;
    with +=
        estimator_.model().variance * discrepancy_covariance(shared_->places, at.angles, estimator_.model().lengths);
    const double before =
        row.squaredNorm() / observations + estimator_.model().variance + estimator_.model().error_variance;
    shared_->factors.solve_lower_in_place(with.data());
    return std::sqrt(shared_->scale * std::max(before - with.squaredNorm(), 0.0));
  }

  /// To how many deviations an interval reaches to either side.
  [[nodiscard]] double deviations_of(confidence_level level) const noexcept {
    return gonio::deviations_of(level, samples_);
  }

  /// Around an estimate, each channel on its own; never below zero.
  [[nodiscard]] reflectance_interval interval(const rgb& estimate, const location& at, confidence_level level) const {
    const double reach = deviations_of(level) * deviation(at);
    const auto moved = [&](double by) {
      const auto& metric = estimator_.prior().metric();
      rgb value;
      for (Eigen::Index c = 0; c < 3; ++c)
        value[c] = std::max(metric.inverse(metric.forward(estimate[c], at) + by, at), 0.0);
      return value;
    };
    return {moved(-reach), moved(reach)};
  }

  /// Around the value of a fit in two directions, which are above the horizon.
  template <brdf Fit>
  [[nodiscard]] reflectance_interval interval(const Fit& fit, const direction& wi, const direction& wo,
                                              confidence_level level) const {
    return interval(fit(wi, wo), locate(estimator_.prior().cells(), to_half_difference(wi, wo)), level);
  }

  /// The deviations at all of some cells. O(n (n + k)) for each: choose a coarse grid, deviations are smooth.
  [[nodiscard]] std::vector<double> deviations(const valid_cells& cells, thread_count threads = {}) const {
    std::vector<double> all(cells.size());
    for_each_index(
        cells.size(), 64,
        [&](Eigen::Index cell) { all[cell] = deviation(locate(estimator_.prior().cells(), cells.angles(cell))); },
        threads);
    return all;
  }

 private:
  struct stored {
    stored(const discrepancy_decomposition<Metric>& estimator, const located_samples& samples)
        : rows(rows_at(estimator.prior(), samples.locations)),
          places(samples.angles()),
          factors(estimator.covariance(samples)) {
      if (!factors.positive_definite()) refuse("the covariance of the samples is not positive definite");
      const Eigen::MatrixXd whitened = factors.solve_lower(estimator.mapped_values(samples));
      constexpr double before = 10.0;
      const auto n = static_cast<double>(rows.rows()), channels = static_cast<double>(whitened.cols());
      scale = (before + whitened.squaredNorm() / channels) / (before + n);
    }

    Eigen::MatrixXd rows;  ///< the prior's functions at the samples, n x k
    std::vector<half_difference> places;
    cholesky factors;
    double scale = 1.0;
  };

  [[nodiscard]] static located_samples some_of(const located_samples& samples) {
    if (samples.size() <= most_samples) return samples;
    return samples.subset(random_choice(samples.size(), most_samples, 0));
  }

  discrepancy_decomposition<Metric> estimator_;
  Eigen::Index samples_;
  std::shared_ptr<const stored> shared_;
};

/// To which factor the highlight is known, with a probability of 95 %: the median over half vectors within 5 degrees of
/// the normal and difference angles up to 70 degrees. O(200 n (n + k)) for n samples and k components.
template <error_metric Metric>
[[nodiscard]] double highlight_factor(const posterior<Metric>& known, const valid_cells& cells) {
  std::vector<double> deviations;
  for (int theta_h = 0; theta_h < 5; ++theta_h)
    for (int theta_d = 5; theta_d < 70; theta_d += 10)
      for (int phi_d = 0; phi_d < 180; phi_d += 30) {
        const half_difference angles{radians(theta_h), radians(theta_d), radians(phi_d)};
        deviations.push_back(known.deviation(locate(cells, angles)));
      }
  return std::exp(known.deviations_of(confidence_level::ninety_five_percent) * median(deviations));
}

}  // namespace gonio
