#pragma once
/// The distance between texels: the difference of their mapped values. A distance between weights would not do, because
/// a component with most of the variance of materials would count as much as one with almost none. The prior's
/// components are orthogonal over its cells, and their norms are the singular values s. The squared difference of the
/// mapped values of weights V x and V y, summed over all cells, is therefore (x - y)' V' diag(s^2) V (x - y). T' T is
/// this matrix divided by 3 times the number of cells, so the distance is the Euclidean distance of T x and T y.

#include <gonio/basis/pca.hpp>

#include <Eigen/Core>

namespace gonio {

/// Returns T, r x r, for the functions V, k x r (`texel_decomposition::functions`). For a texel with the weights x in
/// each channel, stack T x of its three channels. The Euclidean distance of two texels' stacks is the root mean square,
/// over all cells and channels, of the difference of their mapped values, in natural logarithms (0.1 is 10 %). Rows are
/// sorted by variance, the largest first. Throws gonio::error if V does not have k rows. O(k r^2).
[[nodiscard]] Eigen::MatrixXf texel_metric(const log_relative_pca& prior, const Eigen::MatrixXf& functions);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/texels/impl/texel_metric.ipp>
#endif
