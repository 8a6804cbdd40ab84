#pragma once
/// Tikhonov's penalty eta (Nielsen et al. 2015, doi:10.1145/2816795.2818085, Eq. 12) as what it is, a noise parameter.
///
/// Prior: c ~ N(0, I/m), since the coefficients of the m training observations have orthonormal columns. With row error
/// variance sigma^2, the posterior mean minimises |Q c - y|^2 + m sigma^2 |c|^2. sigma^2 is the variance of the noise
/// plus that of the model error, which is estimated by leaving out each training material. Results:
/// docs/results/eta.md.

#include <gonio/estimate/basis_equations.hpp>
#include <gonio/estimate/leave_one_material_out_error.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/solve/choose_eta.hpp>

#include <Eigen/Core>

#include <algorithm>

namespace gonio {

/// The eta that is expected to reconstruct best from samples at these locations: their values do not matter. `noise`:
/// the deviation of a measured value relative to it, independent in each sample and channel; 0.02 is 2 %. Throws
/// gonio::error for unusable samples, noise that is negative or not finite, and a prior of fewer than two materials.
///
/// ```cpp
/// const double eta = gonio::eta_of_noise(prior, samples, 0.02);
/// const auto paint = gonio::decomposition{prior, gonio::tikhonov{eta}}.fit(samples);
/// ```
template <error_metric Metric, class Samples>
[[nodiscard]] double eta_of_noise(const pca<Metric>& prior, const Samples& samples, double noise,
                                  thread_count threads = {}) {
  const located_samples located = locate_samples(prior.cells(), samples, threads);
  detail::summed_scores<leave_one_material_out_error> errors;  // of each channel, if these do not count alike
  for (Eigen::Index column = 0; column < located.weights.cols(); ++column) {
    const Eigen::VectorXd weights = located.weights.col(column);
    if (weights.isZero(0.0)) continue;
    errors.parts.emplace_back(prior, located.locations, weights, noise, threads);
  }
  // Less than 1e-7 of the largest eigenvalue is no penalty; a hundred times that eigenvalue leaves the mean material.
  const double largest = errors.largest();
  return detail::eta_of_least(errors, 1e-7 * largest, 1e2 * largest);
}

/// The etas of no noise and of the largest that is plausible, for cross-validation to choose between: of a few rows GCV
/// sees no more than how well they predict each other, and by chance asks for any. Throws as `eta_of_noise` does.
template <error_metric Metric, class Samples>
[[nodiscard]] eta_range plausible_etas(const pca<Metric>& prior, const Samples& samples, double largest_noise = 0.3,
                                       thread_count threads = {}) {
  const double without = eta_of_noise(prior, samples, 0.0, threads);
  const double with = eta_of_noise(prior, samples, largest_noise, threads);
  return {std::min(without, with), std::max(without, with)};
}

/// For samples whose noise nobody knows: the eta of generalised cross-validation among the plausible ones, one for all
/// channels; for a single sample the largest of these. Errors that samples have in common, as those of images whose
/// camera is off its place, it does not see. Throws as `eta_of_noise` does.
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
