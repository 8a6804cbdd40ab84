#pragma once
/// Least squares without penalty or constraints, for problems of any rank: orthogonal factorisation, minimum norm.
/// Golub and Van Loan, Matrix Computations, 4th ed. 2013, 5.4-5.5 (QR with column pivoting, rank-deficient problems).

#include <gonio/solve/row_equations.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

namespace gonio {

/// Minimises |W^(1/2) (A x - b)|^2; of all minimisers, the x of the smallest norm.
///
/// A problem with rows is solved by orthogonal factorisation of W^(1/2) A, never through its Gram matrix, which would
/// square the condition number. It uses Householder QR, a block of rows at a time if there are more than about a
/// thousand, then QR with column pivoting of the remaining triangle. The rank is determined with all columns scaled to
/// length 1, so it does not depend on their units. The minimised norm is that of x itself. O(n k^2) tall, O(n^2 k)
/// wide.
///
/// Normal equations without rows are solved by an eigendecomposition of Q scaled to unit diagonal, O(k^3). There,
/// rounding hides everything below about sqrt(epsilon) of the largest singular value: see `gram_threshold`.
///
/// The KKT residual tests that the whole gradient vanishes, even if the rank was truncated: `stationarity` for normal
/// equations, and for a problem with rows the same from the rows, relative to |b| + sum of |a_i| |x_i|. Truncation
/// leaves at most about its threshold. With rows this is far below 1e-9 by default. With normal equations alone it can
/// be up to 1e-7, if some singular values of the columns cannot be distinguished from zero in Q. The KKT residual then
/// states their share of the gradient, and only the rows can give a better solution.
class least_squares {
 public:
  /// Singular values of normal equations below this share of the largest count as zero, or below the rank threshold if
  /// that is larger. Rounding leaves a few times 1e-16 of the largest eigenvalue in eigenvalues that should be zero,
  /// and an eigenvalue is the square of a singular value.
  static constexpr double gram_threshold = 1e-7;

  /// `rank_threshold` is the share of a column's length up to which it counts as a linear combination of others. Throws
  /// gonio::error unless it is at least 0 and less than 1.
  explicit least_squares(double rank_threshold = 1e-12);

  [[nodiscard]] double rank_threshold() const noexcept { return threshold_; }

  /// Throws gonio::error if a row is not finite, naming it, or if the weights found explain less than zeros would.
  /// Columns that depend on each other up to 1e-12 can get weights of 1e12 |b|, which have no digits left for b.
  [[nodiscard]] solution solve(const least_squares_problem& problem) const;
  [[nodiscard]] solution solve(const normal_equations& normal) const;

  /// Returns the number of linearly independent columns, as used by `solve`.
  [[nodiscard]] Eigen::Index rank(const least_squares_problem& problem) const;
  [[nodiscard]] Eigen::Index rank(const normal_equations& normal) const;

 private:
  double threshold_;
};

static_assert(normal_solver<least_squares>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/least_squares.ipp>
#endif
