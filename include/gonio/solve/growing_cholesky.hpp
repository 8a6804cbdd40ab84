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
/// along contiguous memory. A template only so that nobody pays for compiling it who does not use it.
template <class Scalar = double>
class growing_cholesky {
 public:
  explicit growing_cholesky(Eigen::Index capacity) : factor_(capacity, capacity), inverse_(capacity) {}

  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }
  /// What the columns before leave of the square of the one at `position`.
  [[nodiscard]] Scalar pivot(Eigen::Index position) const {
    return factor_(position, position) * factor_(position, position);
  }
  void clear() noexcept { size_ = 0; }

  /// Adds the column whose products with those present are `cross` (size() values, destroyed) and with itself `square`.
  /// Returns false and changes nothing if it depends on them up to rounding. O(p^2).
  bool append(Eigen::Ref<Eigen::VectorX<Scalar>> cross, Scalar square) {
    const Scalar pivot = forward(cross, square);
    const auto rounding = 4 * std::numeric_limits<Scalar>::epsilon() * static_cast<Scalar>(size_ + 1);
    if (!(pivot > rounding * square)) return false;
    factor_.row(size_).head(size_) = cross.transpose();
    set_diagonal(size_, std::sqrt(pivot));
    ++size_;
    return true;
  }

  /// Takes the column at `position` out: the rows below move up, and rotations of neighbouring columns make them
  /// triangular again. O((p - position)^2).
  void remove(Eigen::Index position) {
    GONIO_ASSERT(position < size_);
    --size_;
    for (Eigen::Index row = position; row < size_; ++row)
      factor_.row(row).head(row + 2) = factor_.row(row + 1).head(row + 2);
    for (Eigen::Index column = position; column < size_; ++column) {
      const Scalar a = factor_(column, column), b = factor_(column, column + 1), length = std::hypot(a, b);
      const Scalar cosine = a / length, sine = b / length;
      set_diagonal(column, length);
      for (Eigen::Index row = column + 1; row < size_; ++row) {
        const Scalar left = factor_(row, column), right = factor_(row, column + 1);
        factor_(row, column) = cosine * left + sine * right;
        factor_(row, column + 1) = cosine * right - sine * left;
      }
    }
  }

  /// Solves Q_PP z = z in place. O(p^2).
  void solve(Eigen::Ref<Eigen::VectorX<Scalar>> z) const {
    for (Eigen::Index row = 0; row < size_; ++row)
      z[row] = (z[row] - factor_.row(row).head(row).transpose().dot(z.head(row))) * inverse_[row];
    for (Eigen::Index row = size_ - 1; row >= 0; --row) {
      z[row] *= inverse_[row];
      z.head(row) -= z[row] * factor_.row(row).head(row).transpose();
    }
  }

 private:
  /// L^-1 cross in place; returns what is left of the new column's square.
  [[nodiscard]] Scalar forward(Eigen::Ref<Eigen::VectorX<Scalar>> cross, Scalar square) const {
    for (Eigen::Index row = 0; row < size_; ++row)
      cross[row] = (cross[row] - factor_.row(row).head(row).transpose().dot(cross.head(row))) * inverse_[row];
    return square - cross.head(size_).squaredNorm();
  }

  void set_diagonal(Eigen::Index row, Scalar value) {
    factor_(row, row) = value;
    inverse_[row] = Scalar(1) / value;
  }

  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> factor_;
  Eigen::VectorX<Scalar> inverse_;  // of the diagonal: divisions in a row would wait for one another
  Eigen::Index size_ = 0;
};

}  // namespace gonio
