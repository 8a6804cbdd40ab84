#pragma once
/// Products in single precision, of tables and of sweeps over all candidates, compiled once (see dense.hpp). Of a
/// row-major table T and of what is stored as it is, T B is `add_product(b_transposed, t.transpose(),
/// sum.transpose())`: the transposes are views.

#include <gonio/solve/matrix_view.hpp>

namespace gonio {

/// A matrix of floats or a block of one, its columns contiguous.
using float_matrix_view = Eigen::Ref<const Eigen::MatrixXf, 0, Eigen::OuterStride<>>;

/// Where a product is added to: the same, writable.
using float_matrix_block = Eigen::Ref<Eigen::MatrixXf, 0, Eigen::OuterStride<>>;

/// A B for m x k and k x n: 2 m n k operations.
[[nodiscard]] Eigen::MatrixXf product(const float_matrix_view& a, const float_matrix_view& b);

/// sum += A B.
void add_product(const float_matrix_view& a, const float_matrix_view& b, float_matrix_block sum);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/float_product.ipp>
#endif
