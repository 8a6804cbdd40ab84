#pragma once
/// Dense algebra in double precision, through few instantiations of Eigen's templates.
///
/// Each kind of product or factorisation that a file names costs its compiler up to two seconds, since Eigen generates
/// its kernels for every combination of types. Whoever needs one calls these functions instead: all of them take
/// matrices stored by columns, and `gonio::compiled` has them compiled already. An expression that is no matrix with
/// contiguous columns, such as a transpose, is copied into one: O(m n) beside the O(m n k) of the product.

#include <gonio/solve/matrix_view.hpp>

namespace gonio {

/// A B for m x k and k x n: 2 m n k operations. `product(a.transpose(), b)` is A' B.
[[nodiscard]] Eigen::MatrixXd product(const matrix_view& a, const matrix_view& b);

/// A A', both triangles, of m x k: m^2 k operations.
[[nodiscard]] Eigen::MatrixXd product_with_transpose(const matrix_view& a);

/// The Cholesky factorisation A = L L' of a symmetric matrix, whose lower triangle is read; k^3 / 3 operations.
class cholesky {
 public:
  explicit cholesky(const matrix_view& a);

  /// Was A positive definite? If it was not, `solve` means nothing.
  [[nodiscard]] bool positive_definite() const noexcept { return positive_definite_; }

  /// A^-1 B: 2 k^2 operations for each column of B.
  [[nodiscard]] Eigen::MatrixXd solve(const matrix_view& b) const;
  /// L^-1 B: k^2 operations for each column of B.
  [[nodiscard]] Eigen::MatrixXd solve_lower(const matrix_view& b) const;

  /// The logarithm of A's determinant.
  [[nodiscard]] double log_determinant() const;

 private:
  Eigen::MatrixXd lower_;  ///< L in the lower triangle
  bool positive_definite_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/dense.ipp>
#endif
