#pragma once
/// Least squares without penalty or constraints, for problems of any rank: orthogonal factorisation, minimum norm.
/// Golub and Van Loan, Matrix Computations, 4th ed. 2013, 5.4-5.5 (QR with column pivoting, rank-deficient problems).

#include <gonio/solve/row_equations.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

namespace gonio {

/// Minimises |W^(1/2) (A x - b)|^2; of all minimisers, the x of the smallest norm.
///
/// A problem that has rows is solved by orthogonal factorisation of W^(1/2) A and never through its Gram matrix, which
/// would square the condition number: Householder QR, a block of rows at a time if there are more than about a
/// thousand, then QR with column pivoting of the triangle that remains. The rank is decided with all columns scaled to
/// length 1, and hence does not depend on their units; the norm that is smallest is that of x itself. O(n k^2) tall,
/// O(n^2 k) wide.
///
/// Normal equations alone are solved by an eigendecomposition of Q scaled to unit diagonal, O(k^3). Rounding hides
/// there whatever is below about sqrt(epsilon) of the largest singular value: see `gram_threshold`.
///
/// The KKT residual is that all of the gradient vanishes, also where the rank was truncated: `stationarity` for normal
/// equations, and the same from the rows (relative to |b| + sum of |a_i| |x_i|) where there are rows. Truncation leaves
/// at most about its threshold there. That is far below 1e-9 by default where there are rows. For normal equations
/// alone it can be up to 1e-7, if the columns have singular values which Q cannot tell from zero: the KKT residual then
/// says how much of the gradient they hold, and only the rows can give a better solution.
class least_squares {
 public:
  /// Singular values of normal equations below this share of the largest are taken for zero, or below the rank
  /// threshold if that is more. Rounding leaves about 1e-16 times a few of the largest eigenvalue, the square of a
  /// singular value, in those that should be zero.
  static constexpr double gram_threshold = 1e-7;

  /// A column is taken for a linear combination of others if these say it to `rank_threshold` of its length. Throws
  /// gonio::error unless it is at least 0 and less than 1.
  explicit least_squares(double rank_threshold = 1e-12);

  [[nodiscard]] double rank_threshold() const noexcept { return threshold_; }

  /// Throws gonio::error if a row is not finite, naming it, or if weights of zero explain more than those found:
  /// columns that depend on each other but for 1e-12 can take weights of 1e12 |b|, in which nothing is left of b.
  [[nodiscard]] solution solve(const least_squares_problem& problem) const;
  [[nodiscard]] solution solve(const normal_equations& normal) const;

  /// How many columns are linearly independent, as `solve` counts them.
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
