#pragma once
/// Bodies of solve/householder_qr.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/householder_qr.hpp>
#include <gonio/solve/vector_kernels.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gonio {

GONIO_INLINE householder_qr::householder_qr(Eigen::MatrixXd a) : packed_(std::move(a)) {
  const Eigen::Index n = packed_.rows(), k = packed_.cols();
  factors_ = Eigen::VectorXd::Zero(std::min(n, k));
  for (Eigen::Index number = 0; number < factors_.size(); ++number) {
    double* top = &packed_(number, number);
    const Eigen::Index below = n - number - 1;
    if (norm(top + 1, below) == 0.0) continue;
    // What is left of a column that depends on others may be denormal: a power of two gives its digits back.
    const double inverse = near_inverse(norm(top, below + 1));
    for (Eigen::Index i = 0; i <= below; ++i) top[i] *= inverse;
    const double reflected = -std::copysign(norm(top, below + 1), *top), first = *top - reflected;
    factors_[number] = -first / reflected;
    for (Eigen::Index i = 1; i <= below; ++i) top[i] /= first;
    *top = reflected / inverse;
    for (Eigen::Index column = number + 1; column < k; ++column) reflect(number, &packed_(0, column));
  }
}

GONIO_INLINE double householder_qr::length(Eigen::Index column) const {
  return norm(&packed_(0, column), std::min(column + 1, rows()));
}

GONIO_INLINE void householder_qr::reflect(Eigen::Index number, double* y) const {
  const Eigen::Index below = rows() - number - 1;
  const double* v = packed_.data() + number * rows() + number + 1;
  const double amount = factors_[number] * (y[number] + dot(v, y + number + 1, below));
  y[number] -= amount;
  add_scaled(-amount, v, y + number + 1, below);
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
