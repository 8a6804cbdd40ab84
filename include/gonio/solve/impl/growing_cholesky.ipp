#pragma once
/// Bodies of solve/growing_cholesky.hpp.

#include <gonio/core/assertion.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/solve/growing_cholesky.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace gonio {

GONIO_INLINE bool growing_cholesky::append(Eigen::Ref<Eigen::VectorXd> cross, double square) {
  const double pivot = forward(cross, square);
  const auto rounding = 4 * std::numeric_limits<double>::epsilon() * static_cast<double>(size_ + 1);
  if (!(pivot > rounding * square)) return false;
  factor_.row(size_).head(size_) = cross.transpose();
  set_diagonal(size_, std::sqrt(pivot));
  ++size_;
  return true;
}

GONIO_INLINE void growing_cholesky::remove(Eigen::Index position) {
  GONIO_ASSERT(position < size_);
  --size_;
  for (Eigen::Index row = position; row < size_; ++row)
    factor_.row(row).head(row + 2) = factor_.row(row + 1).head(row + 2);
  for (Eigen::Index column = position; column < size_; ++column) {
    const double a = factor_(column, column), b = factor_(column, column + 1), length = std::hypot(a, b);
    const double cosine = a / length, sine = b / length;
    set_diagonal(column, length);
    for (Eigen::Index row = column + 1; row < size_; ++row) {
      const double left = factor_(row, column), right = factor_(row, column + 1);
      factor_(row, column) = cosine * left + sine * right;
      factor_(row, column + 1) = cosine * right - sine * left;
    }
  }
}

GONIO_INLINE void growing_cholesky::solve(Eigen::Ref<Eigen::VectorXd> z) const {
  for (Eigen::Index row = 0; row < size_; ++row)
    z[row] = (z[row] - factor_.row(row).head(row).transpose().dot(z.head(row))) * inverse_[row];
  for (Eigen::Index row = size_ - 1; row >= 0; --row) {
    z[row] *= inverse_[row];
    z.head(row) -= z[row] * factor_.row(row).head(row).transpose();
  }
}

GONIO_INLINE double growing_cholesky::forward(Eigen::Ref<Eigen::VectorXd> cross, double square) const {
  for (Eigen::Index row = 0; row < size_; ++row)
    cross[row] = (cross[row] - factor_.row(row).head(row).transpose().dot(cross.head(row))) * inverse_[row];
  return square - cross.head(size_).squaredNorm();
}

GONIO_INLINE void growing_cholesky::set_diagonal(Eigen::Index row, double value) {
  factor_(row, row) = value;
  inverse_[row] = 1.0 / value;
}

}  // namespace gonio
