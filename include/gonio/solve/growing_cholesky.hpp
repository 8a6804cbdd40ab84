#pragma once
/// The Cholesky factor of the Gram matrix of a set of columns that grows and shrinks by one: what active-set methods
/// solve their subproblems with. Golub and Van Loan, Matrix Computations, 4th ed., sections 4.2 and 6.5.

#include <gonio/core/assertion.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace gonio {

/// L with L L' = Q_PP for the columns P in the order in which they came. Lies row by row, so that solving with it runs
/// along contiguous memory.
class growing_cholesky {
 public:
  explicit growing_cholesky(Eigen::Index capacity) : factor_(capacity, capacity), inverse_(capacity) {}

  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }
  /// What the columns before leave of the square of the one at `position`.
  [[nodiscard]] double pivot(Eigen::Index position) const {
    return factor_(position, position) * factor_(position, position);
  }
  void clear() noexcept { size_ = 0; }

  /// Adds the column whose products with those present are `cross` (size() values, destroyed) and with itself `square`.
  /// Returns false and changes nothing if it depends on them up to rounding. O(p^2).
  bool append(Eigen::Ref<Eigen::VectorXd> cross, double square);

  /// Takes the column at `position` out: the rows below move up, and rotations of neighbouring columns make them
  /// triangular again. O((p - position)^2).
  void remove(Eigen::Index position);

  /// Solves Q_PP z = z in place. O(p^2).
  void solve(Eigen::Ref<Eigen::VectorXd> z) const;

 private:
  /// L^-1 cross in place; returns what is left of the new column's square.
  [[nodiscard]] double forward(Eigen::Ref<Eigen::VectorXd> cross, double square) const;

  void set_diagonal(Eigen::Index row, double value);

  row_matrix factor_;
  Eigen::VectorXd inverse_;  // of the diagonal: divisions in a row would wait for one another
  Eigen::Index size_ = 0;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/growing_cholesky.ipp>
#endif
