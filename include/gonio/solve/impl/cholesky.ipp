#pragma once
/// Bodies of solve/cholesky.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/vector_kernels.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace gonio {

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

// Substitution by our own loops rather than Eigen's, which generates a blocked kernel for each triangle, and without a
// matrix product, which costs every program that solves a system a second of compilation.

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
