#pragma once
/// The standard deviation of a prior's materials along each principal component: the unit for edits of a material.
/// Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Eq. 5-7: a channel of a material is mu + Q c, and its weights c
/// are a row of U.

#include <gonio/basis/pca.hpp>

#include <Eigen/Core>

namespace gonio {

/// Returns the standard deviation of each column of `coefficients`. A column has the weights of one component, for all
/// channels of all materials. For components as learned, the deviation is 1 / sqrt(3 materials), because the columns of
/// U have the length 1 and the mean 0. A weight of 1 is far outside of the range of materials. O(k materials).
[[nodiscard]] Eigen::VectorXd weight_deviations(const Eigen::MatrixXf& coefficients);

/// Returns each component's share of the observations' variance; the shares sum to `explained_variance()`.
template <error_metric Metric>
[[nodiscard]] Eigen::VectorXd variance_shares(const pca<Metric>& prior) {
  const auto squares = prior.singular_values().array().square();
  return prior.explained_variance() * squares / squares.sum();
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/component_variance.ipp>
#endif
