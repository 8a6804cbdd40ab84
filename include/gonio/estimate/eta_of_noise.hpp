#pragma once
/// Tikhonov's penalty eta (Nielsen et al. 2015, doi:10.1145/2816795.2818085, Eq. 12) computed from the measurement
/// noise.
///
/// The coefficients of the m training observations have orthonormal columns, so the prior of the weights is c ~ N(0,
/// I/m). If the error of each row of Q has the variance sigma^2, the posterior mean minimises |Q c - y|^2 + m sigma^2
/// |c|^2: eta = m sigma^2. Here sigma^2 is the variance of the noise plus the variance of the model error, which
/// appears if each training material is left out of the prior. Results: docs/results/eta.md.

#include <gonio/estimate/basis_equations.hpp>
#include <gonio/estimate/leave_one_material_out_error.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/solve/choose_eta.hpp>

#include <Eigen/Core>

#include <algorithm>

namespace gonio {

/// Returns the eta with the least expected reconstruction error for samples at these locations. The samples' values do
/// not matter. `noise` is the standard deviation of a measured value relative to it (0.02 is 2 %), independent in each
/// sample and channel. Throws gonio::error for unusable samples, for noise that is negative or not finite, and for a
/// prior of fewer than two materials.
///
/// ```cpp
/// const double eta = gonio::eta_of_noise(prior, samples, 0.02);
/// const auto paint = gonio::decomposition{prior, gonio::tikhonov{eta}}.fit(samples);
/// ```
template <error_metric Metric, class Samples>
[[nodiscard]] double eta_of_noise(const pca<Metric>& prior, const Samples& samples, double noise,
                                  thread_count threads = {}) {
  const located_samples located = locate_samples(prior.cells(), samples, threads);
  detail::summed_scores<leave_one_material_out_error>
      errors;  // one for each channel, if channels have different weights
  for (Eigen::Index column = 0; column < located.weights.cols(); ++column) {
    const Eigen::VectorXd weights = located.weights.col(column);
    if (weights.isZero(0.0)) continue;
    errors.parts.emplace_back(prior, located.locations, weights, noise, threads);
  }
  // An eta below 1e-7 of the largest eigenvalue has no effect; an eta of 100 times that eigenvalue gives the mean
  // material.
  const double largest = errors.largest();
  return detail::eta_of_least(errors, 1e-7 * largest, 1e2 * largest);
}

/// Returns the range of etas for cross-validation: from the eta without noise to the eta of the largest plausible
/// noise. Without this range, cross-validation of few samples may choose any eta by chance, because it only uses how
/// well the samples predict each other. Throws as `eta_of_noise` does.
template <error_metric Metric, class Samples>
[[nodiscard]] eta_range plausible_etas(const pca<Metric>& prior, const Samples& samples, double largest_noise = 0.3,
                                       thread_count threads = {}) {
  const double without = eta_of_noise(prior, samples, 0.0, threads);
  const double with = eta_of_noise(prior, samples, largest_noise, threads);
  return {std::min(without, with), std::max(without, with)};
}

/// Returns the eta for samples of unknown noise, the same for all channels. Generalised cross-validation chooses the
/// eta within the range of `plausible_etas`; for a single sample, it is the largest eta of the range. Cross-validation
/// cannot detect errors that samples share, such as those of images with a wrong camera position. Throws as
/// `eta_of_noise` does.
///
/// ```cpp
/// const double eta = gonio::eta_of_unknown_noise(prior, samples);
/// const auto paint = gonio::decomposition{prior, gonio::tikhonov{eta}}.fit(samples);
/// ```
template <error_metric Metric, class Samples>
[[nodiscard]] double eta_of_unknown_noise(const pca<Metric>& prior, const Samples& samples, double largest_noise = 0.3,
                                          thread_count threads = {}) {
  return choose_eta(basis_equations(prior, locate_samples(prior.cells(), samples, threads), threads).problems(),
                    eta_criterion::generalised_cross_validation,
                    plausible_etas(prior, samples, largest_noise, threads));
}

}  // namespace gonio
