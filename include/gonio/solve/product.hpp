#pragma once
/// Products of matrices in double precision, compiled once (see dense.hpp).

#include <gonio/solve/matrix_view.hpp>

namespace gonio {

/// Returns A B for A of m x k and B of k x n: 2 m n k operations. `product(a.transpose(), b)` is A' B.
[[nodiscard]] Eigen::MatrixXd product(const matrix_view& a, const matrix_view& b);

/// Adds A B to `sum`, through a temporary product: for few columns.
void add_product(const matrix_view& a, const matrix_view& b, Eigen::MatrixXd& sum);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/product.ipp>
#endif
