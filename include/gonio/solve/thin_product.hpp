#pragma once
/// Products with matrices of a few columns, such as the right-hand sides of three colour channels. Reading the large
/// matrix dominates their cost, so processing it in blocks would not help.

#include <gonio/solve/matrix_view.hpp>

namespace gonio {

/// Returns A B for A of m x k and B of k x n, as sums of columns of A: 2 m n k operations, reads A n times.
[[nodiscard]] Eigen::MatrixXd thin_product(const matrix_view& a, const matrix_view& b);

/// Returns A' B for A of k x m and B of k x n, as products of their columns: 2 m n k operations, reads A n times.
[[nodiscard]] Eigen::MatrixXd thin_transposed_product(const matrix_view& a, const matrix_view& b);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/thin_product.ipp>
#endif
