#pragma once
/// QR factorisation by Householder reflections, one column after the other: Golub and Van Loan, Matrix Computations,
/// 4th ed. 2013, 5.2.2. Eigen's factorisation works on blocks of columns and is faster from some hundred columns on,
/// but costs every file that includes it five seconds of compilation. The solvers only need a factorisation in the rare
/// cases where normal equations are not enough.

#include <Eigen/Core>

namespace gonio {

namespace detail {

/// Replaces x (`count` numbers) by (r, v), where the reflection I - f (1, v)(1, v)' maps x to (r, 0, ...). Returns f;
/// returns 0 if all numbers of x but the first are already 0.
[[nodiscard]] double make_reflection(double* x, Eigen::Index count);

/// Replaces y by y - f (1, v)(1, v)'y. y has `count` numbers, v has one number less.
void reflect(double factor, const double* v, double* y, Eigen::Index count);

}  // namespace detail

/// The factorisation A = Q R of an n x k matrix. R is min(n, k) x k and upper triangular; numbers on its diagonal have
/// either sign. 2 k^2 (n - k/3) operations.
class householder_qr {
 public:
  explicit householder_qr(Eigen::MatrixXd a);

  [[nodiscard]] Eigen::Index rows() const noexcept { return packed_.rows(); }
  [[nodiscard]] Eigen::Index cols() const noexcept { return packed_.cols(); }

  /// Returns R(row, column) for row <= column.
  [[nodiscard]] double triangle(Eigen::Index row, Eigen::Index column) const { return packed_(row, column); }
  /// Returns the length of a column of R, which equals the length of this column of A.
  [[nodiscard]] double length(Eigen::Index column) const;

  /// Replace y (n numbers) by Q'y or by Q y. O(n k).
  void apply_transposed(double* y) const;
  void apply(double* y) const;

  /// Replace z (k numbers) by R^-1 z or by R'^-1 z, for k <= n and no zero on the diagonal of R. O(k^2).
  void solve(double* z) const;
  void solve_transposed(double* z) const;

 private:
  void reflect(Eigen::Index number, double* y) const;

  Eigen::MatrixXd packed_;   // R; below its diagonal, v of each reflection I - f (1, v)(1, v)'
  Eigen::VectorXd factors_;  // f
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/householder_qr.ipp>
#endif
