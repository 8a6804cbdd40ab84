#pragma once
/// Bodies of solve/cholesky.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/product_sum.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

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
    for (Eigen::Index j = begin; j < end; ++j) explained.put(j - begin, &lower_(end, j), k - end);
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

namespace detail {

/// Takes L x from a tile of some columns of x, `known` unknowns of which are found; both matrices have k rows. A tile
/// of the size of `product_sum`'s stays in registers, as there.
template <std::size_t... Column>
inline void subtract_known(const double* lower, const double* found, Eigen::Index known, double* tile, Eigen::Index k,
                           std::index_sequence<Column...> /*columns*/) {
  using piece = Eigen::Array<double, product_sum<double>::strip_columns, 1>;
  std::array<piece, sizeof...(Column)> sums{((void)Column, piece(piece::Zero()))...};
  for (Eigen::Index j = 0; j < known; ++j) {
    const piece rows = Eigen::Map<const piece>(lower + j * k);
    ((sums[Column] += rows * found[j + Column * k]), ...);
  }
  ((Eigen::Map<piece>(tile + Column * k) -= sums[Column]), ...);
}

}  // namespace detail

GONIO_INLINE Eigen::MatrixXd cholesky::solve_lower(const matrix_view& b) const {
  // Solve for some unknowns of all columns, then take them from the other equations.
  using sum_type = detail::product_sum<double>;
  constexpr Eigen::Index panel = 32, rows = sum_type::strip_columns, columns = sum_type::tile_columns;
  const Eigen::Index k = lower_.rows();
  Eigen::MatrixXd x = b;
  for (Eigen::Index begin = 0; begin < k; begin += panel) {
    const Eigen::Index end = std::min(begin + panel, k);
    for (Eigen::Index column = 0; column < x.cols(); ++column)
      for (Eigen::Index j = begin; j < end; ++j) {
        const double known = x(j, column) /= lower_(j, j);
        add_scaled(-known, lower_.data() + j * (k + 1) + 1, &x(j, column) + 1, end - j - 1);
      }
    Eigen::Index row = end;
    for (; row + rows <= k; row += rows) {
      const auto subtract = [&](Eigen::Index column, auto together) {
        detail::subtract_known(&lower_(row, begin), &x(begin, column), end - begin, &x(row, column), k, together);
      };
      Eigen::Index column = 0;
      for (; column + columns <= x.cols(); column += columns) subtract(column, std::make_index_sequence<columns>());
      for (; column < x.cols(); ++column) subtract(column, std::make_index_sequence<1>());
    }
    if (row == k) continue;
    for (Eigen::Index column = 0; column < x.cols(); ++column)
      for (Eigen::Index j = begin; j < end; ++j) add_scaled(-x(j, column), &lower_(row, j), &x(row, column), k - row);
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
