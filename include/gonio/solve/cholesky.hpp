#pragma once
/// Gram matrices of rows, and the Cholesky factorisation of symmetric matrices, compiled once (see dense.hpp).
/// Golub and Van Loan, Matrix Computations, 4th ed. 2013, 4.2.

#include <gonio/solve/matrix_view.hpp>

namespace gonio {

/// Returns A A', both triangles, for A of m x k: m^2 k operations.
[[nodiscard]] Eigen::MatrixXd product_with_transpose(const matrix_view& a);

/// The Cholesky factorisation A = L L' of a symmetric matrix. Reads its lower triangle; k^3 / 3 operations.
class cholesky {
 public:
  explicit cholesky(const matrix_view& a);

  /// Returns true if A is positive definite. Otherwise the solutions are meaningless.
  [[nodiscard]] bool positive_definite() const noexcept { return positive_definite_; }

  /// Returns A^-1 B: 2 k^2 operations for each column of B.
  [[nodiscard]] Eigen::MatrixXd solve(const matrix_view& b) const;
  /// Returns A^-1: 2 k^3 operations.
  [[nodiscard]] Eigen::MatrixXd inverse() const;
  /// Returns L^-1 B: k^2 operations for each column of B.
  [[nodiscard]] Eigen::MatrixXd solve_lower(const matrix_view& b) const;
  /// Returns L'^-1 B: k^2 operations for each column of B.
  [[nodiscard]] Eigen::MatrixXd solve_upper(const matrix_view& b) const;
  /// Replaces k contiguous numbers b by L^-1 b.
  void solve_lower_in_place(double* b) const noexcept;

  /// Returns the logarithm of A's determinant.
  [[nodiscard]] double log_determinant() const;

 private:
  Eigen::MatrixXd lower_;  ///< L in the lower triangle
  bool positive_definite_ = false;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/cholesky.ipp>
#endif
