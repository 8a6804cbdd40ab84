#pragma once
/// The spread of a prior's materials along each of its principal components, which is the unit of edits. Nielsen et al.
/// 2015 (doi:10.1145/2816795.2818085), Eq. 5-7: a material is mu + Q c, and the rows of U are the c of the materials.

#include <gonio/basis/pca.hpp>

#include <Eigen/Core>

namespace gonio {

/// Returns the standard deviations of the materials' weights c, one for each component: of the columns of
/// `coefficients`, over all materials and channels, about their means. For components as learned it is 1 / sqrt(3
/// materials), because the columns of U have the length 1 and the mean 0. A weight of 1 is far outside of the range of
/// materials. O(k materials).
[[nodiscard]] Eigen::VectorXd weight_deviations(const Eigen::MatrixXf& coefficients);

/// Returns the share of the observations' variance of each component; the sum is `explained_variance()`.
template <error_metric Metric>
[[nodiscard]] Eigen::VectorXd variance_shares(const pca<Metric>& prior) {
  const auto squares = prior.singular_values().array().square();
  return prior.explained_variance() * squares / squares.sum();
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/component_variance.ipp>
#endif
