#pragma once
/// Least squares in the directions that explain most of the matrix: regularisation by truncated singular value
/// decomposition. Hansen, BIT 27, 1987 (doi:10.1007/BF01937276). The share of explained variance is chosen as by
/// Nielsen, "Anatomically correct surface recovery" (doctoral thesis, DTU 2016, contribution C.V, Eq. 4-7).

#include <gonio/solve/solver.hpp>

namespace gonio {

/// Keeps the fewest singular values of W^(1/2) A whose squares sum to a given share of the sum of all squares. Returns
/// the x of the smallest norm that minimises |W^(1/2) (A x - b)| in the subspace of the kept right singular vectors.
///
/// A wide problem (fewer rows than unknowns) is solved through its n x n dual in O(n^2 k), all others through the k x k
/// normal equations. Both give the same x, unless the share ends within a group of equal singular values. The squares
/// are computed as eigenvalues. A share of 1 therefore drops the smallest squares, which are rounding errors: up to a
/// sum of k epsilon of the total for k squares. If such directions matter, use `least_squares`.
///
/// The KKT residual is computed from the problem and an orthonormal basis V of the subspace, and is the largest of
/// - the part of A'WA V outside of the subspace, |(I - VV') A'WA V|, relative to the largest eigenvalue of A'WA: zero
///   if singular vectors span the subspace;
/// - the gradient in the subspace, |V'(A'W(A x - b))|, relative to |A'Wb| + that eigenvalue times |x|;
/// - the part of x outside of the subspace, relative to |x|.
/// The magnitude |.| is that of the largest entry.
class truncated_svd {
 public:
  /// Throws gonio::error unless the share is above 0 and at most 1.
  explicit truncated_svd(double explained_variance = 0.99);

  [[nodiscard]] double explained_variance() const noexcept { return share_; }

  [[nodiscard]] solution solve(const least_squares_problem& problem) const;
  [[nodiscard]] solution solve(const normal_equations& normal) const;

  /// Returns the number of singular values that `solve` keeps.
  [[nodiscard]] Eigen::Index kept(const least_squares_problem& problem) const;
  [[nodiscard]] Eigen::Index kept(const normal_equations& normal) const;

 private:
  double share_;
};

static_assert(normal_solver<truncated_svd>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/truncated_svd.ipp>
#endif
