#pragma once
/// Bodies of solve/singular_values.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/householder_qr.hpp>
#include <gonio/solve/singular_values.hpp>
#include <gonio/solve/symmetric_eigen.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gonio {

namespace detail {

/// Reflects the rows from row `step` on, so that column `step` of a square matrix becomes (.., d, 0, ...). Returns d.
[[nodiscard]] GONIO_INLINE double reflect_rows(Eigen::Index step, Eigen::MatrixXd& r) {
  const Eigen::Index k = r.cols();
  double* x = &r(step, step);
  const double factor = make_reflection(x, k - step);
  for (Eigen::Index column = step + 1; column < k; ++column) reflect(factor, x + 1, &r(step, column), k - step);
  return *x;
}

/// Reflects the columns after column `step`, so that row `step` becomes (.., e, 0, ...). Returns e. Skips rows above
/// `step`.
[[nodiscard]] GONIO_INLINE double reflect_columns(Eigen::Index step, Eigen::MatrixXd& r) {
  const Eigen::Index first = step + 1, count = r.cols() - first;
  Eigen::VectorXd v(count), along = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) v[i] = r(step, first + i);
  const double factor = make_reflection(v.data(), count), reflected = v[0];
  v[0] = 1.0;
  for (Eigen::Index i = 0; i < count; ++i) add_scaled(v[i], &r(first, first + i), along.data(), count);
  for (Eigen::Index i = 0; i < count; ++i) add_scaled(-factor * v[i], along.data(), &r(first, first + i), count);
  return reflected;
}

/// Reduces a square matrix to upper bidiagonal form by reflections. Returns the diagonal, interleaved with the
/// superdiagonal: d1, e1, d2, e2, ..., dk.
[[nodiscard]] GONIO_INLINE Eigen::VectorXd bidiagonal_of(Eigen::MatrixXd r) {
  const Eigen::Index k = r.cols();
  Eigen::VectorXd found(2 * k - 1);
  for (Eigen::Index step = 0; step < k; ++step) {
    found[2 * step] = reflect_rows(step, r);
    if (step + 1 < k) found[2 * step + 1] = reflect_columns(step, r);
  }
  return found;
}

/// Returns the triangle R of the QR factorisation of a tall matrix.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd triangle_of(Eigen::MatrixXd a) {
  const householder_qr qr(std::move(a));
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(qr.cols(), qr.cols());
  for (Eigen::Index column = 0; column < qr.cols(); ++column)
    for (Eigen::Index row = 0; row <= column; ++row) triangle(row, column) = qr.triangle(row, column);
  return triangle;
}

}  // namespace detail

GONIO_INLINE Eigen::VectorXd singular_values(const matrix_view& a, const char* what) {
  const Eigen::Index k = std::min(a.rows(), a.cols());
  if (k == 0) return {};
  double largest = 0.0;
  for (Eigen::Index j = 0; j < a.cols(); ++j)
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      if (!std::isfinite(a(i, j))) refuse({"the singular values of ", what, " are undefined: a value is not finite"});
      largest = std::max(largest, std::abs(a(i, j)));
    }
  if (largest == 0.0) return Eigen::VectorXd::Zero(k);
  Eigen::MatrixXd tall = a.rows() >= a.cols() ? Eigen::MatrixXd(a) : Eigen::MatrixXd(a.transpose());
  tall /= largest;
  if (tall.rows() > k) tall = detail::triangle_of(std::move(tall));
  // A tridiagonal matrix with a zero diagonal and these numbers beside it has the eigenvalues +-sigma. Shift it by a
  // bound of the eigenvalues, because the iteration needs a positive matrix to decide which numbers are negligible.
  const Eigen::VectorXd beside = detail::bidiagonal_of(std::move(tall));
  double bound = 0.0;
  for (Eigen::Index i = 0; i < 2 * k; ++i)
    bound = std::max(bound, (i > 0 ? std::abs(beside[i - 1]) : 0.0) + (i < 2 * k - 1 ? std::abs(beside[i]) : 0.0));
  const Eigen::VectorXd both = tridiagonal_eigenvalues(Eigen::VectorXd::Constant(2 * k, bound), beside, what);
  Eigen::VectorXd values(k);
  for (Eigen::Index i = 0; i < k; ++i) values[i] = largest * std::max(both[k + i] - bound, 0.0);
  return values;
}

}  // namespace gonio
