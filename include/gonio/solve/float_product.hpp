#pragma once
/// Products in single precision, for tables and for searches over all candidates, compiled once (see dense.hpp). To add
/// the product T B with a row-major table T to `sum`, write `add_product(b_transposed, t.transpose(),
/// sum.transpose())`, where the transposes are views and nothing is copied.

#include <gonio/solve/matrix_view.hpp>

namespace gonio {

/// A matrix of floats, or a block of one, with contiguous columns.
using float_matrix_view = Eigen::Ref<const Eigen::MatrixXf, 0, Eigen::OuterStride<>>;

/// A writable matrix of floats or a block of one, with contiguous columns.
using float_matrix_block = Eigen::Ref<Eigen::MatrixXf, 0, Eigen::OuterStride<>>;

/// Returns A B for A of m x k and B of k x n: 2 m n k operations.
[[nodiscard]] Eigen::MatrixXf product(const float_matrix_view& a, const float_matrix_view& b);

/// Adds A B to sum.
void add_product(const float_matrix_view& a, const float_matrix_view& b, float_matrix_block sum);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/float_product.ipp>
#endif
