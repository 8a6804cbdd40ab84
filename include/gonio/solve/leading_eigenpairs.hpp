#pragma once
/// The largest eigenvalues of a Gram matrix, with their vectors. The matrix is either in memory or, if it is too large,
/// only multiplied by random vectors. Halko, Martinsson and Tropp, "Finding Structure with Randomness", SIAM Review
/// 2011 (doi:10.1137/090771806), Alg. 4.4 (the subspace) and 5.3 (its eigenpairs).

#include <Eigen/Core>

#include <cstdint>
#include <functional>

namespace gonio {

/// Eigenpairs, the largest first. The largest entry of each vector is positive, so that no result depends on a solver's
/// sign.
struct leading_eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  ///< orthonormal columns
  /// As many eigenvalues of the matrix are within this distance of `values`: the Frobenius norm of G V - V diag(values)
  /// (Parlett, The Symmetric Eigenvalue Problem, 1998, 11.5). 0 for a matrix in memory.
  double residual = 0.0;
};

/// Returns at most `count` eigenpairs of a positive semidefinite matrix, without those that are rounding errors. About
/// 9 k^3 operations. Throws gonio::error naming `what` was decomposed if the iteration does not converge.
[[nodiscard]] leading_eigenpairs decompose_leading(const Eigen::MatrixXd& matrix, Eigen::Index count, const char* what);

struct subspace_options {
  Eigen::Index oversampling = 40;  ///< vectors in addition to those asked for
  int products = 3;                ///< with the matrix, at least 1; all but the last are power iterations
  std::uint64_t seed = 1;
};

/// Eigenpairs, and the coefficients of their vectors in the last orthonormal subspace: vectors = subspace combination.
struct subspace_eigenpairs {
  leading_eigenpairs pairs;
  Eigen::MatrixXd combination;
};

/// Multiplies the matrix by vectors; `last` is true for the last product.
using matrix_times = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& vectors, bool last)>;

/// Returns the leading eigenpairs of a matrix of `size` rows that is only multiplied. Holds four matrices of size x
/// (count + oversampling). The same seed gives the same bytes. Throws gonio::error for options that are not positive.
[[nodiscard]] subspace_eigenpairs iterate_leading(Eigen::Index size, Eigen::Index count,
                                                  const subspace_options& options, const matrix_times& times);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/leading_eigenpairs.ipp>
#endif
