#pragma once
/// Bodies of solve/cholesky.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/product_sum.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace gonio {

GONIO_INLINE Eigen::MatrixXd product_with_transpose(const matrix_view& a) {
  using sum_type = detail::product_sum<double>;
  sum_type sum(a.rows(), std::min(a.cols(), sum_type::block_rows));
  for (Eigen::Index begin = 0; begin < a.cols(); begin += sum_type::block_rows) {
    const Eigen::Index count = std::min(a.cols() - begin, sum_type::block_rows);
    for (Eigen::Index i = 0; i < count; ++i) sum.put(i, a.data() + (begin + i) * a.outerStride(), a.rows());
    sum.add(count);
  }
  return sum.symmetric();
}

GONIO_INLINE cholesky::cholesky(const matrix_view& a) : lower_(a) {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(lower_);  // in place
  positive_definite_ = factors.info() == Eigen::Success;
  // Check the diagonal, because Eigen accepts NaN as positive.
  for (Eigen::Index k = 0; k < lower_.rows(); ++k) positive_definite_ = positive_definite_ && lower_(k, k) > 0.0;
}

GONIO_INLINE void cholesky::solve_lower_in_place(double* b) const noexcept {
  Eigen::Map<Eigen::VectorXd> x(b, lower_.rows());
  lower_.triangularView<Eigen::Lower>().solveInPlace(x);
}

GONIO_INLINE Eigen::MatrixXd cholesky::solve_lower(const matrix_view& b) const {
  Eigen::MatrixXd x = b;
  lower_.triangularView<Eigen::Lower>().solveInPlace(x);
  return x;
}

GONIO_INLINE Eigen::MatrixXd cholesky::solve_upper(const matrix_view& b) const {
  Eigen::MatrixXd x = b;
  lower_.triangularView<Eigen::Lower>().transpose().solveInPlace(x);
  return x;
}

GONIO_INLINE Eigen::MatrixXd cholesky::solve(const matrix_view& b) const { return solve_upper(solve_lower(b)); }

GONIO_INLINE Eigen::MatrixXd cholesky::inverse() const {
  Eigen::MatrixXd identity = Eigen::MatrixXd::Zero(lower_.rows(), lower_.rows());
  for (Eigen::Index k = 0; k < lower_.rows(); ++k) identity(k, k) = 1.0;
  return solve(identity);
}

GONIO_INLINE double cholesky::log_determinant() const {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < lower_.rows(); ++k) sum += std::log(lower_(k, k));
  return 2.0 * sum;
}

}  // namespace gonio
