#pragma once
/// Least squares without penalty or constraints, for problems of any rank, by orthogonal factorisation. If the solution
/// is not unique, it is that of the smallest norm. Golub and Van Loan, Matrix Computations, 4th ed. 2013, 5.4-5.5 (QR
/// with column pivoting, rank-deficient problems).

#include <gonio/solve/row_equations.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

namespace gonio {

/// Minimises |W^(1/2) (A x - b)|^2. If several x are minimal, returns the x of the smallest norm.
///
/// A problem with rows is solved by orthogonal factorisation of W^(1/2) A, never through its Gram matrix, which would
/// square the condition number. Rows are reduced to a triangle by Householder QR (a block at a time if there are more
/// than about a thousand rows), and the triangle is factorised by QR with column pivoting. The rank is determined with
/// all columns scaled to length 1, so it does not depend on their units. The minimised norm is that of x itself. O(n
/// k^2) for n rows of k <= n columns, O(n^2 k) for more columns.
///
/// Normal equations without rows are solved by an eigendecomposition of Q scaled to unit diagonal, O(k^3). In Q,
/// rounding hides singular values below about sqrt(epsilon) of the largest: see `gram_threshold`.
///
/// The KKT residual tests that the whole gradient vanishes, even if the rank was truncated. Normal equations use
/// `stationarity`; a problem with rows uses its rows, relative to |b| + sum of |a_i| |x_i| over the columns a_i.
/// Truncation leaves a gradient of at most about its threshold: by default far below 1e-9 with rows, and up to 1e-7
/// with normal equations alone, if Q does not distinguish some singular values from zero. In that case, only the rows
/// can give a better solution.
class least_squares {
 public:
  /// With normal equations, a singular value counts as zero if it is below this share of the largest, or below the rank
  /// threshold if that is larger. Rounding leaves a few times 1e-16 of the largest eigenvalue in eigenvalues that
  /// should be zero, and an eigenvalue is the square of a singular value.
  static constexpr double gram_threshold = 1e-7;

  /// A column counts as a linear combination of other columns if its remainder is at most `rank_threshold` times its
  /// length. Throws gonio::error unless the threshold is at least 0 and less than 1.
  explicit least_squares(double rank_threshold = 1e-12);

  [[nodiscard]] double rank_threshold() const noexcept { return threshold_; }

  /// Throws gonio::error if a row is not finite (the message names the row), or if the weights found fit worse than
  /// zero weights. Columns that depend on each other up to 1e-12 can get weights of 1e12 |b|, which have no digits left
  /// for b.
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
