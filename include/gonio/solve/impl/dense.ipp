#pragma once
/// Bodies of solve/dense.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/dense.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <cmath>

namespace gonio {

GONIO_INLINE Eigen::MatrixXd product(const matrix_view& a, const matrix_view& b) { return a * b; }

GONIO_INLINE Eigen::MatrixXd product_with_transpose(const matrix_view& a) {
  const Eigen::Index n = a.rows();
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n, n);
  whole.selfadjointView<Eigen::Lower>().rankUpdate(a);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j + 1; i < n; ++i) whole(j, i) = whole(i, j);
  return whole;
}

GONIO_INLINE cholesky::cholesky(const matrix_view& a) : lower_(a), positive_definite_(false) {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(lower_);
  positive_definite_ = in_place.info() == Eigen::Success;
}

GONIO_INLINE Eigen::MatrixXd cholesky::solve(const matrix_view& b) const {
  Eigen::MatrixXd x = solve_lower(b);
  lower_.triangularView<Eigen::Lower>().transpose().solveInPlace(x);
  return x;
}

GONIO_INLINE Eigen::MatrixXd cholesky::solve_lower(const matrix_view& b) const {
  Eigen::MatrixXd x = b;
  lower_.triangularView<Eigen::Lower>().solveInPlace(x);
  return x;
}

GONIO_INLINE double cholesky::log_determinant() const {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < lower_.rows(); ++k) sum += std::log(lower_(k, k));
  return 2.0 * sum;
}

}  // namespace gonio
