#pragma once
/// Eigenvalues and eigenvectors of symmetric matrices in double precision, compiled once (see dense.hpp).
/// Golub and Van Loan, Matrix Computations, 4th ed. 2013, 8.3 (tridiagonalisation and QR iteration).

#include <gonio/solve/matrix_view.hpp>

namespace gonio {

/// The decomposition A = V diag(values) V', values ascending.
struct symmetric_eigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  ///< orthonormal columns
};

/// Decomposes a symmetric k x k matrix, whose lower triangle is read; about 9 k^3 operations. Throws gonio::error if
/// the iteration does not converge; `what` names the matrix in the message.
[[nodiscard]] symmetric_eigen decompose_symmetric(const matrix_view& a, const char* what);

/// Returns the eigenvalues of a symmetric k x k matrix alone, ascending: about 4/3 k^3 operations.
[[nodiscard]] Eigen::VectorXd symmetric_eigenvalues(const matrix_view& a, const char* what);

/// Returns the eigenvalues of a symmetric tridiagonal k x k matrix, ascending, given its diagonal and subdiagonal:
/// O(k^2).
[[nodiscard]] Eigen::VectorXd tridiagonal_eigenvalues(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside,
                                                      const char* what);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/symmetric_eigen.ipp>
#endif
