#pragma once
/// How far texels are apart. Weights of functions say little by themselves: a component that carries most of what
/// materials differ by counts as much as one that carries next to nothing. What counts is the difference of the mapped
/// values that they stand for. The prior's components are orthogonal over its cells, with the singular values s as
/// norms, so that weights V x and V y differ there by (x - y)' V' diag(s^2) V (x - y), summed over all cells: a
/// Euclidean distance of T x and T y, with T' T that matrix.

#include <gonio/basis/pca.hpp>

#include <Eigen/Core>

namespace gonio {

/// T, r x r, of functions V, k x r (`texel_decomposition::functions`): the distance of T x and T y of one texel's three
/// channels and another's, stacked, is the root mean square over all cells and channels of the difference of their
/// mapped values; natural logarithms, so that 0.1 is 10 %. Rows are those of most variance first. Throws gonio::error
/// if V has not k rows. O(k r^2).
[[nodiscard]] Eigen::MatrixXf texel_metric(const log_relative_pca& prior, const Eigen::MatrixXf& functions);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/texels/impl/texel_metric.ipp>
#endif
