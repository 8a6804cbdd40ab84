#pragma once
/// Nielsen et al. 2015 (doi:10.1145/2816795.2818085), section 8, with the paper's estimator. Learns two priors from a
/// database split by contrast, and makes a ridge reconstruction (Eq. 12) with the prior that the samples choose.

#include <gonio/basis/pca.hpp>
#include <gonio/basis/soft_specular_prior.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/soft_or_specular.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Core>

#include <optional>

namespace gonio {

/// Learns the principal components of each half of a database, relative to one reference: `split_by_contrast`, then
/// `learn_pca` of each half. Keeps at most `components` of each. Copies each half in turn. Throws gonio::error as these
/// functions do. O(cells materials^2).
///
/// ```cpp
/// const auto reference = gonio::log_relative::to_median_of(materials);
/// const auto prior = gonio::learn_soft_specular_prior(materials, reference, 60);
/// const auto paint = gonio::soft_specular_decomposition(prior,
/// gonio::penalties_in_proportion(prior, 40.0)).fit(samples);
/// ```
[[nodiscard]] soft_specular_prior learn_soft_specular_prior(const material_set& materials,
                                                            const log_relative& reference, Eigen::Index components,
                                                            std::optional<double> threshold = {},
                                                            thread_count threads = {}, const progress& listener = {});

/// Tikhonov's penalty of each half.
struct soft_specular_penalties {
  double soft = 0.0, specular = 0.0;
};

/// Returns the penalties of two halves, given the penalty `eta` of a prior of all materials. The weights of principal
/// components have the variance 1 / (3 materials) for any materials, so the penalty for the same noise is proportional
/// to their number.
[[nodiscard]] soft_specular_penalties penalties_in_proportion(const soft_specular_prior& prior, double eta);

/// The paper's reconstruction by one prior.
using ridge_reconstruction = decomposition<log_relative_pca, tikhonov>;

/// Makes the paper's reconstruction with the prior that the samples choose. Throws gonio::error unless the penalties
/// are positive. Its `fit` throws as that of `soft_or_specular`.
[[nodiscard]] soft_or_specular<ridge_reconstruction, ridge_reconstruction> soft_specular_decomposition(
    const soft_specular_prior& prior, const soft_specular_penalties& eta, thread_count threads = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/soft_specular_decomposition.ipp>
#endif
