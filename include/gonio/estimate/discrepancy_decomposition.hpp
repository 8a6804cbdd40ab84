#pragma once
/// A prior's components and what they cannot say, fitted together: principal components (Nielsen et al. 2015,
/// doi:10.1145/2816795.2818085, Eq. 12) and a Gaussian process beside them (Kennedy and O'Hagan 2001,
/// doi:10.1111/1467-9868.00294). Where few directions were measured the components decide, where many were the
/// measurements themselves. Results on real materials, with families left out: docs/results/real-materials.md.

#include <gonio/basis/discrepancy.hpp>
#include <gonio/basis/joined.hpp>
#include <gonio/basis/pca.hpp>
#include <gonio/core/random.hpp>
#include <gonio/estimate/basis_equations.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/mapped_noise.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Core>

#include <cmath>
#include <utility>
#include <vector>

namespace gonio {

/// What is assumed of materials that a prior has not seen, in the squared units of its metric (natural logarithms of
/// `log_relative`). The defaults are those of least error on twenty measured materials of the RGL database, each
/// reconstructed by a prior without its family, at 5 to 500 measurements; choosing them anew for each material by the
/// marginal likelihood was worse there.
struct discrepancy_model {
  double variance = 0.02;         ///< of the discrepancy
  double error_variance = 0.007;  ///< of what is neither prior nor discrepancy, independent at each measurement
  correlation_lengths lengths = {};
  double noise = 0.0;  ///< of the measurements, relative to them: 0.02 is 2 %
  /// Around so many measurements, chosen at random, there are functions: beside them a discrepancy is smoothed.
  Eigen::Index most_centres = 1000;
  /// So many samples, chosen at random, are fitted: beside at most 1,100 functions more of them change little.
  Eigen::Index most_samples = 200'000;
};

/// Fits components and discrepancy together, in one system. An `estimator`.
///
/// With m observations in the prior, components have the coefficients c ~ N(0, I / m) and the discrepancy the variance
/// `variance`: `tikhonov` with eta = m error_variance, of a basis that joins the components to a discrepancy of
/// amplitude m variance around what was measured, finds the posterior mean. Noise takes weight from the samples in
/// proportion.
///
/// ```cpp
/// const auto paint = gonio::discrepancy_decomposition{prior}.fit(samples);
/// ```
template <error_metric Metric>
class discrepancy_decomposition {
 public:
  using basis_type = joined<pca<Metric>, discrepancy<Metric>>;

  /// Throws gonio::error for an impossible model.
  explicit discrepancy_decomposition(pca<Metric> prior, const discrepancy_model& model = {}, thread_count threads = {})
      : prior_(std::move(prior)), model_(model), threads_(threads) {
    if (!(model.error_variance > 0.0 && std::isfinite(model.error_variance)))
      refuse({"the error variance beside a discrepancy must be positive and finite, not ", model.error_variance});
    if (model.most_centres < 1 || model.most_samples < 1)
      refuse("a discrepancy needs at least one centre and one sample");
  }

  [[nodiscard]] const pca<Metric>& prior() const noexcept { return prior_; }
  [[nodiscard]] const discrepancy_model& model() const noexcept { return model_; }
  /// m: 3 for each material of the prior.
  [[nodiscard]] double observations() const noexcept { return static_cast<double>(prior_.coefficients().rows()); }

  /// n samples, k components and c centres: O(n^2 (k + c)) if they are all centres, O(n (k + c)^2) if not. Throws
  /// gonio::error for unusable samples.
  template <class Samples>
  [[nodiscard]] fitted_brdf<basis_type> fit(const Samples& samples) const {
    return fit_located(locate_samples(prior_.cells(), samples, threads_));
  }

  /// The same of samples that are located on the prior's cells.
  [[nodiscard]] fitted_brdf<basis_type> fit_located(located_samples samples) const {
    auto [functions, found] = solve_located(std::move(samples));
    return {std::move(functions), std::move(found)};
  }

  [[nodiscard]] const valid_cells& cells() const noexcept { return prior_.cells(); }

  /// The same without its end, of any number of channels: what `fit_spectra` goes on with.
  [[nodiscard]] solved_channels<basis_type> solve_located(located_samples samples) const {
    if (samples.size() > model_.most_samples)
      samples = samples.subset(random_choice(samples.size(), model_.most_samples, 0));
    samples.weights.array().colwise() *= model_.error_variance / error_variances(samples);
    basis_type functions = functions_for(samples);
    const basis_equations equations(functions, std::move(samples), threads_);
    return {std::move(functions), equations.solve(tikhonov(observations() * model_.error_variance))};
  }

  /// The covariance of the samples, errors included, in the metric's domain: n x n. A sample's weight, the mean of its
  /// channels', divides the variance of its error. O(n^2 k).
  [[nodiscard]] Eigen::MatrixXd covariance(const located_samples& samples) const {
    const auto n = samples.size();
    Eigen::MatrixXd all = product_with_transpose(rows_at(prior_, samples.locations)) / observations();
    all += model_.variance * discrepancy_covariance(samples.angles(), model_.lengths);
    const Eigen::ArrayXd errors = error_variances(samples) / samples.weights.rowwise().mean().array();
    for (Eigen::Index i = 0; i < n; ++i) all(i, i) += errors[i];
    return all;
  }

  /// The samples in the metric's domain, less the prior's mean: n x 3.
  [[nodiscard]] Eigen::MatrixXd mapped_values(const located_samples& samples) const {
    Eigen::MatrixXd mapped = samples.values;
    for (Eigen::Index i = 0; i < mapped.rows(); ++i) {
      const location& at = samples.locations[i];
      const double offset = offset_at(prior_, at);
      for (Eigen::Index c = 0; c < mapped.cols(); ++c)
        mapped(i, c) = prior_.metric().forward(mapped(i, c), at) - offset;
    }
    return mapped;
  }

 private:
  /// Of each sample's error: the model's, and what its noise is in the metric's domain.
  [[nodiscard]] Eigen::ArrayXd error_variances(const located_samples& samples) const {
    return model_.error_variance + map_noise(prior_, samples.locations, model_.noise, threads_).variance.array();
  }

  [[nodiscard]] basis_type functions_for(const located_samples& samples) const {
    const Eigen::Index most = model_.most_centres;
    std::vector<half_difference> centres;
    for (const Eigen::Index i : random_choice(samples.size(), most, 0)) centres.push_back(samples.locations[i].angles);
    return {prior_, discrepancy<Metric>(prior_.cells(), prior_.metric(), centres, observations() * model_.variance,
                                        model_.lengths)};
  }

  pca<Metric> prior_;
  discrepancy_model model_;
  thread_count threads_;
};

}  // namespace gonio
