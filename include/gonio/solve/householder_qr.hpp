#pragma once
/// QR factorisation by Householder reflections, one column after the other: Golub and Van Loan, Matrix Computations,
/// 4th ed. 2013, 5.2.2. Eigen's works on blocks of columns, is faster from some hundred columns on, and costs whoever
/// includes it five seconds; the solvers need one where normal equations are not enough, which is seldom.

#include <Eigen/Core>

namespace gonio {

namespace detail {

/// x becomes (r, v) where the reflection I - f (1, v)(1, v)' takes x to (r, 0, ...); returns f, 0 where x is so
/// already.
[[nodiscard]] double make_reflection(double* x, Eigen::Index count);

/// y becomes y - f (1, v)(1, v)'y: `count` numbers, of which v has one less.
void reflect(double factor, const double* v, double* y, Eigen::Index count);

}  // namespace detail

/// A = Q R for n x k: R is min(n, k) x k, upper triangular, with either sign on its diagonal. 2 k^2 (n - k/3)
/// operations.
class householder_qr {
 public:
  explicit householder_qr(Eigen::MatrixXd a);

  [[nodiscard]] Eigen::Index rows() const noexcept { return packed_.rows(); }
  [[nodiscard]] Eigen::Index cols() const noexcept { return packed_.cols(); }

  /// R(row, column) for row <= column.
  [[nodiscard]] double triangle(Eigen::Index row, Eigen::Index column) const { return packed_(row, column); }
  /// The norm of a column of R down to its diagonal: that of the column of A.
  [[nodiscard]] double length(Eigen::Index column) const;

  /// y becomes Q'y, or Q y: n numbers. O(n k).
  void apply_transposed(double* y) const;
  void apply(double* y) const;

  /// z becomes R^-1 z, or R'^-1 z: k numbers, for k <= n and no zero on the diagonal of R. O(k^2).
  void solve(double* z) const;
  void solve_transposed(double* z) const;

 private:
  void reflect(Eigen::Index number, double* y) const;

  Eigen::MatrixXd packed_;   // R, and below its diagonal the reflections I - f v v' with v = (1, below)
  Eigen::VectorXd factors_;  // f
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/householder_qr.ipp>
#endif
