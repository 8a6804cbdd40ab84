#pragma once
/// The method of Nielsen et al. 2015 (doi:10.1145/2816795.2818085), section 8, with the paper's estimator. Splits a
/// database by contrast into soft and specular materials, learns a prior from each, and reconstructs by ridge
/// regression (Eq. 12) with the prior that the samples indicate.

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

/// Learns the principal components of the soft and of the specular materials of a database, relative to the same
/// reference: calls `split_by_contrast`, and then `learn_pca` for each of the two sets. Keeps at most `components` of
/// each. Copies the database. Throws gonio::error as these two functions do. O(cells materials^2).
///
/// ```cpp
/// const auto reference = gonio::log_relative::to_median_of(materials);
/// const auto prior = gonio::learn_soft_specular_prior(materials, reference, 60);
/// const auto estimator = gonio::soft_specular_decomposition(prior, gonio::penalties_in_proportion(prior, 40.0));
/// const auto paint = estimator.fit(samples);
/// ```
[[nodiscard]] soft_specular_prior learn_soft_specular_prior(const material_set& materials,
                                                            const log_relative& reference, Eigen::Index components,
                                                            std::optional<double> threshold = {},
                                                            thread_count threads = {}, const progress& listener = {});

struct soft_specular_penalties {
  double soft = 0.0, specular = 0.0;
};

/// Returns the penalties of the soft and of the specular prior, given the penalty `eta` of a prior of all materials.
/// For the same noise, the penalty is proportional to the number of materials, because the weights of the components
/// have the variance 1 / (3 materials).
[[nodiscard]] soft_specular_penalties penalties_in_proportion(const soft_specular_prior& prior, double eta);

/// The paper's reconstruction by a single prior.
using ridge_reconstruction = decomposition<log_relative_pca, tikhonov>;

/// Returns the paper's reconstruction, which uses the soft or the specular prior, depending on the samples. Throws
/// gonio::error unless the penalties are positive. The result's `fit` throws as `soft_or_specular::fit` does.
[[nodiscard]] soft_or_specular<ridge_reconstruction, ridge_reconstruction> soft_specular_decomposition(
    const soft_specular_prior& prior, const soft_specular_penalties& eta, thread_count threads = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/soft_specular_decomposition.ipp>
#endif
