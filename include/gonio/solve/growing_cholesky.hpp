#pragma once
/// The Cholesky factor of the Gram matrix of a set of columns that grows or shrinks by one column at a time, for the
/// subproblems of active-set methods. Golub and Van Loan, Matrix Computations, 4th ed., sections 4.2 and 6.5.

#include <gonio/core/assertion.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace gonio {

/// The factor L with L L' = Q_PP for the columns P in the order in which they were added. L is stored by rows, so that
/// solving reads contiguous memory.
class growing_cholesky {
 public:
  explicit growing_cholesky(Eigen::Index capacity) : factor_(capacity, capacity), inverse_(capacity) {}

  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }
  /// Returns the squared length of the part of the column at `position` that is not in the span of the columns before
  /// it.
  [[nodiscard]] double pivot(Eigen::Index position) const {
    return factor_(position, position) * factor_(position, position);
  }
  void clear() noexcept { size_ = 0; }

  /// Adds a column. `cross` holds its products with the p columns already present, and is overwritten; `square` is its
  /// product with itself. Returns false and leaves the factor unchanged if the column depends on the p columns up to
  /// rounding. O(p^2).
  bool append(Eigen::Ref<Eigen::VectorXd> cross, double square);

  /// Removes the column at `position` of p columns: moves the rows below up, and makes them triangular again by
  /// rotations of neighbouring columns. O((p - position)^2).
  void remove(Eigen::Index position);

  /// Solves Q_PP z = z in place for p columns. O(p^2).
  void solve(Eigen::Ref<Eigen::VectorXd> z) const;

 private:
  /// Replaces `cross` by L^-1 cross. Returns `square` minus the squared norm of the result, which is the square of the
  /// new diagonal element.
  [[nodiscard]] double forward(Eigen::Ref<Eigen::VectorXd> cross, double square) const;

  void set_diagonal(Eigen::Index row, double value);

  row_matrix factor_;
  Eigen::VectorXd inverse_;  // one over the diagonal: successive divisions would wait for each other
  Eigen::Index size_ = 0;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/growing_cholesky.ipp>
#endif
