#pragma once
/// The largest eigenvalues of a Gram matrix, with their eigenvectors. The matrix is in memory or, if it is too large,
/// is only multiplied by vectors, starting with random ones. Halko, Martinsson and Tropp, "Finding Structure with
/// Randomness", SIAM Review 2011 (doi:10.1137/090771806), Alg. 4.4 (the subspace) and 5.3 (its eigenpairs).

#include <Eigen/Core>

#include <cstdint>
#include <functional>

namespace gonio {

/// Eigenpairs, the largest first. The largest entry of each vector is positive: no result depends on the sign that a
/// solver happens to choose.
struct leading_eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  ///< orthonormal columns
  /// The Frobenius norm of G V - V diag(values) for the matrix G. Each value is within this distance of another
  /// eigenvalue of G (Parlett, The Symmetric Eigenvalue Problem, 1998, 11.5). 0 if the matrix was in memory.
  double residual = 0.0;
};

/// Returns the largest eigenpairs of a positive semidefinite k x k matrix: at most `count`, without those that are
/// rounding errors. About 9 k^3 operations. Throws gonio::error if the iteration does not converge; `what` names the
/// matrix in the message.
[[nodiscard]] leading_eigenpairs decompose_leading(const Eigen::MatrixXd& matrix, Eigen::Index count, const char* what);

struct subspace_options {
  Eigen::Index oversampling = 40;  ///< number of vectors in addition to the eigenvectors
  int products = 3;  ///< number of products with the matrix, at least 1; all but the last are power iterations
  std::uint64_t seed = 1;
};

/// Eigenpairs, and the coefficients of the eigenvectors in the last orthonormal subspace: vectors = subspace
/// combination.
struct subspace_eigenpairs {
  leading_eigenpairs pairs;
  Eigen::MatrixXd combination;
};

/// Returns the product of the matrix and `vectors`; `last` is true for the last product.
using matrix_times = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& vectors, bool last)>;

/// Returns the leading eigenpairs of a matrix of `size` rows that is not in memory, but only multiplied. Holds four
/// matrices of size x (count + oversampling). The same seed gives the same bytes. Throws gonio::error for options that
/// are not positive.
[[nodiscard]] subspace_eigenpairs iterate_leading(Eigen::Index size, Eigen::Index count,
                                                  const subspace_options& options, const matrix_times& times);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/leading_eigenpairs.ipp>
#endif
