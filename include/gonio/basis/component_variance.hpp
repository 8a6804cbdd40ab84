#pragma once
/// How far the materials of a prior spread along each of its principal components: what an edit is counted in.
/// Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Eq. 5-7: a material is mu + Q c, and the rows c of U are what the
/// materials have.

#include <gonio/basis/pca.hpp>

#include <Eigen/Core>

namespace gonio {

/// The standard deviations of the materials' weights c, one for each component: those of the columns of `coefficients`,
/// over all materials and channels, about their means. It is 1 / sqrt(3 materials) for each component as it was
/// learned, because the columns of U have the length 1 and the mean 0: a weight of 1 is far beyond any material. O(k
/// materials).
[[nodiscard]] Eigen::VectorXd weight_deviations(const Eigen::MatrixXf& coefficients);

/// The share of the observations' variance that each component has; they add up to `explained_variance()`.
template <error_metric Metric>
[[nodiscard]] Eigen::VectorXd variance_shares(const pca<Metric>& prior) {
  const auto squares = prior.singular_values().array().square();
  return prior.explained_variance() * squares / squares.sum();
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/component_variance.ipp>
#endif
