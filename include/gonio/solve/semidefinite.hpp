#pragma once
/// Symmetric systems that may be singular, compiled once (see dense.hpp).
/// Golub and Van Loan, Matrix Computations, 4th ed. 2013, 4.2.8 (symmetric pivoting).

#include <gonio/solve/matrix_view.hpp>

namespace gonio {

/// Solves A X = B for a symmetric positive semidefinite k x k matrix A, whose lower triangle is read. X is zero in
/// directions in which A vanishes. Uses L D L' with pivoting: k^3 / 3 operations, and 2 k^2 for each column of B.
[[nodiscard]] Eigen::MatrixXd solve_semidefinite(const matrix_view& a, const matrix_view& b);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/semidefinite.ipp>
#endif
