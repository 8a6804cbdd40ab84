#pragma once
/// Bodies of solve/householder_qr.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/householder_qr.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gonio::detail {

GONIO_INLINE double make_reflection(double* x, Eigen::Index count) {
  if (norm(x + 1, count - 1) == 0.0) return 0.0;
  // Scale by a power of two. If a column depends on others, its remainder may be denormal, and scaling restores its
  // digits.
  const double inverse = near_inverse(norm(x, count));
  for (Eigen::Index i = 0; i < count; ++i) x[i] *= inverse;
  const double reflected = -std::copysign(norm(x, count), *x), first = *x - reflected;
  for (Eigen::Index i = 1; i < count; ++i) x[i] /= first;
  *x = reflected / inverse;
  return -first / reflected;
}

GONIO_INLINE void reflect(double factor, const double* v, double* y, Eigen::Index count) {
  const double amount = factor * (y[0] + dot(v, y + 1, count - 1));
  y[0] -= amount;
  add_scaled(-amount, v, y + 1, count - 1);
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE householder_qr::householder_qr(Eigen::MatrixXd a) : packed_(std::move(a)) {
  const Eigen::Index n = packed_.rows(), k = packed_.cols();
  factors_ = Eigen::VectorXd::Zero(std::min(n, k));
  for (Eigen::Index number = 0; number < factors_.size(); ++number) {
    factors_[number] = detail::make_reflection(&packed_(number, number), n - number);
    if (factors_[number] == 0.0) continue;
    for (Eigen::Index column = number + 1; column < k; ++column) reflect(number, &packed_(0, column));
  }
}

GONIO_INLINE double householder_qr::length(Eigen::Index column) const {
  return norm(&packed_(0, column), std::min(column + 1, rows()));
}

GONIO_INLINE void householder_qr::reflect(Eigen::Index number, double* y) const {
  const double* v = packed_.data() + number * rows() + number + 1;
  detail::reflect(factors_[number], v, y + number, rows() - number);
}

GONIO_INLINE void householder_qr::apply_transposed(double* y) const {
  for (Eigen::Index number = 0; number < factors_.size(); ++number) reflect(number, y);
}

GONIO_INLINE void householder_qr::apply(double* y) const {
  for (Eigen::Index number = factors_.size() - 1; number >= 0; --number) reflect(number, y);
}

GONIO_INLINE void householder_qr::solve(double* z) const {
  for (Eigen::Index j = cols() - 1; j >= 0; --j) {
    z[j] /= packed_(j, j);
    add_scaled(-z[j], &packed_(0, j), z, j);
  }
}

GONIO_INLINE void householder_qr::solve_transposed(double* z) const {
  for (Eigen::Index j = 0; j < cols(); ++j) z[j] = (z[j] - dot(&packed_(0, j), z, j)) / packed_(j, j);
}

}  // namespace gonio
