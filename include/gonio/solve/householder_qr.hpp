#pragma once
/// QR factorisation by Householder reflections, one column after the other: Golub and Van Loan, Matrix Computations,
/// 4th ed. 2013, 5.2.2. Eigen's works on blocks of columns and is faster from some hundred columns on, but costs every
/// includer five seconds. The solvers only need a factorisation in the rare cases where normal equations are not
/// enough.

#include <Eigen/Core>

namespace gonio {

namespace detail {

/// Replaces x by (r, v), where the reflection I - f (1, v)(1, v)' maps x to (r, 0, ...). Returns f; 0 if x already has
/// that form.
[[nodiscard]] double make_reflection(double* x, Eigen::Index count);

/// Replaces y by y - f (1, v)(1, v)'y. y has `count` numbers, v one less.
void reflect(double factor, const double* v, double* y, Eigen::Index count);

}  // namespace detail

/// A = Q R for n x k. R is min(n, k) x k and upper triangular, with either sign on its diagonal. 2 k^2 (n - k/3)
/// operations.
class householder_qr {
 public:
  explicit householder_qr(Eigen::MatrixXd a);

  [[nodiscard]] Eigen::Index rows() const noexcept { return packed_.rows(); }
  [[nodiscard]] Eigen::Index cols() const noexcept { return packed_.cols(); }

  /// Returns R(row, column) for row <= column.
  [[nodiscard]] double triangle(Eigen::Index row, Eigen::Index column) const { return packed_(row, column); }
  /// Returns the norm of a column of R down to its diagonal, which is that of the column of A.
  [[nodiscard]] double length(Eigen::Index column) const;

  /// Replace y, n numbers, by Q'y or by Q y. O(n k).
  void apply_transposed(double* y) const;
  void apply(double* y) const;

  /// Replace z, k numbers, by R^-1 z or by R'^-1 z, for k <= n and no zero on the diagonal of R. O(k^2).
  void solve(double* z) const;
  void solve_transposed(double* z) const;

 private:
  void reflect(Eigen::Index number, double* y) const;

  Eigen::MatrixXd packed_;   // R, and below its diagonal the v of the reflections I - f (1, v)(1, v)'
  Eigen::VectorXd factors_;  // f
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/householder_qr.ipp>
#endif
