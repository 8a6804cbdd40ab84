#pragma once
/// Bodies of solve/cholesky.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/product_sum.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace gonio {

GONIO_INLINE Eigen::MatrixXd product_with_transpose(const matrix_view& a) {
  using sum_type = detail::product_sum<double>;
  sum_type sum(a.rows(), std::min(a.cols(), sum_type::block_rows));
  for (Eigen::Index begin = 0; begin < a.cols(); begin += sum_type::block_rows) {
    const Eigen::Index count = std::min(a.cols() - begin, sum_type::block_rows);
    for (Eigen::Index i = 0; i < count; ++i)
      std::copy_n(a.data() + (begin + i) * a.outerStride(), a.rows(), sum.row(i));
    sum.add(count);
  }
  return sum.symmetric();
}

// Factorisation and substitution by our own loops. Eigen's generate a blocked kernel for each triangle, and products of
// blocks of blocks: they cost every program that solves a system a second of compilation.

GONIO_INLINE cholesky::cholesky(const matrix_view& a) : lower_(a), positive_definite_(true) {
  constexpr Eigen::Index panel = 64;
  const Eigen::Index k = lower_.rows();
  for (Eigen::Index begin = 0; begin < k && positive_definite_; begin += panel) {
    const Eigen::Index end = std::min(begin + panel, k);
    factorise_columns(begin, end);
    // Take what they explain from the rest: A22 - L21 L21'.
    if (end == k) break;
    detail::product_sum<double> explained(k - end, end - begin);
    for (Eigen::Index j = begin; j < end; ++j) std::copy_n(&lower_(end, j), k - end, explained.row(j - begin));
    explained.add(end - begin);
    explained.subtract_lower_from(&lower_(end, end), k);
  }
}

GONIO_INLINE void cholesky::factorise_columns(Eigen::Index begin, Eigen::Index end) {
  const Eigen::Index k = lower_.rows();
  for (Eigen::Index j = begin; j < end; ++j) {
    double* column = &lower_(j, j);
    for (Eigen::Index known = begin; known < j; ++known)
      add_scaled(-lower_(j, known), &lower_(j, known), column, k - j);
    if (!(column[0] > 0.0)) {
      positive_definite_ = false;
      return;
    }
    const double root = std::sqrt(column[0]);
    for (Eigen::Index i = 0; i < k - j; ++i) column[i] /= root;
  }
}

GONIO_INLINE void cholesky::solve_lower_in_place(double* b) const noexcept {
  const Eigen::Index k = lower_.rows();
  for (Eigen::Index j = 0; j < k; ++j) {
    const double known = b[j] /= lower_(j, j);
    add_scaled(-known, lower_.data() + j * (k + 1) + 1, b + j + 1, k - j - 1);
  }
}

GONIO_INLINE Eigen::MatrixXd cholesky::solve_lower(const matrix_view& b) const {
  // Solve for some unknowns of all columns, then take them from the other equations, a tile of L that stays in the
  // cache after the other.
  constexpr Eigen::Index panel = 64, tile = 256;
  const Eigen::Index k = lower_.rows();
  Eigen::MatrixXd x = b;
  for (Eigen::Index begin = 0; begin < k; begin += panel) {
    const Eigen::Index end = std::min(begin + panel, k);
    for (Eigen::Index column = 0; column < x.cols(); ++column)
      for (Eigen::Index j = begin; j < end; ++j) {
        const double known = x(j, column) /= lower_(j, j);
        add_scaled(-known, lower_.data() + j * (k + 1) + 1, &x(j, column) + 1, end - j - 1);
      }
    for (Eigen::Index row = end; row < k; row += tile)
      for (Eigen::Index column = 0; column < x.cols(); ++column)
        for (Eigen::Index j = begin; j < end; ++j)
          add_scaled(-x(j, column), &lower_(row, j), &x(row, column), std::min(tile, k - row));
  }
  return x;
}

GONIO_INLINE Eigen::MatrixXd cholesky::solve_upper(const matrix_view& b) const {
  const Eigen::Index k = lower_.rows();
  Eigen::MatrixXd x = b;
  for (Eigen::Index column = 0; column < x.cols(); ++column)
    for (Eigen::Index j = k - 1; j >= 0; --j) {
      const double known = dot(lower_.data() + j * (k + 1) + 1, &x(j, column) + 1, k - j - 1);
      x(j, column) = (x(j, column) - known) / lower_(j, j);
    }
  return x;
}

GONIO_INLINE Eigen::MatrixXd cholesky::solve(const matrix_view& b) const { return solve_upper(solve_lower(b)); }

GONIO_INLINE double cholesky::log_determinant() const {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < lower_.rows(); ++k) sum += std::log(lower_(k, k));
  return 2.0 * sum;
}

}  // namespace gonio
