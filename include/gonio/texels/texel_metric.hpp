#pragma once
/// The distance between texels. Weights of functions are not comparable: a component with most of the variance of
/// materials counts as much as one with almost none. The relevant measure is the difference of the mapped values that
/// they represent. The prior's components are orthogonal over its cells, with the singular values s as norms. Weights V
/// x and V y therefore differ by (x - y)' V' diag(s^2) V (x - y), summed over all cells: a Euclidean distance of T x
/// and T y, with T' T that matrix.

#include <gonio/basis/pca.hpp>

#include <Eigen/Core>

namespace gonio {

/// Returns T, r x r, of functions V, k x r (`texel_decomposition::functions`). Stack T x of the three channels of each
/// of two texels: the distance is the root mean square over all cells and channels of the difference of their mapped
/// values, in natural logarithms (0.1 is 10 %). Rows are sorted by variance, the largest first. Throws gonio::error if
/// V does not have k rows. O(k r^2).
[[nodiscard]] Eigen::MatrixXf texel_metric(const log_relative_pca& prior, const Eigen::MatrixXf& functions);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/texels/impl/texel_metric.ipp>
#endif
