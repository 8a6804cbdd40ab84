#pragma once
/// Products of the sweeps over all candidates, which are made in single precision: as solve/dense.hpp, through one
/// instantiation of Eigen's templates.

#include <gonio/solve/dense.hpp>

namespace gonio {

/// A matrix of floats or a block of one, its columns contiguous.
using float_matrix_view = Eigen::Ref<const Eigen::MatrixXf, 0, Eigen::OuterStride<>>;

/// Where a product is added to: the same, writable.
using float_matrix_block = Eigen::Ref<Eigen::MatrixXf, 0, Eigen::OuterStride<>>;

/// A B for m x k and k x n: 2 m n k operations.
[[nodiscard]] Eigen::MatrixXf product(const float_matrix_view& a, const float_matrix_view& b);

/// sum += A B.
void add_product(const float_matrix_view& a, const float_matrix_view& b, float_matrix_block sum);
/// The same in double precision, by way of the product itself: for few columns.
void add_product(const matrix_view& a, const matrix_view& b, Eigen::MatrixXd& sum);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/float_product.ipp>
#endif
