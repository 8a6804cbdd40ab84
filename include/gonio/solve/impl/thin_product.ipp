#pragma once
/// Bodies of solve/thin_product.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/thin_product.hpp>

namespace gonio {

GONIO_INLINE Eigen::MatrixXd thin_product(const matrix_view& a, const matrix_view& b) {
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(a.rows(), b.cols());
  for (Eigen::Index j = 0; j < b.cols(); ++j)
    for (Eigen::Index k = 0; k < a.cols(); ++k)
      add_scaled(b(k, j), a.data() + k * a.outerStride(), c.data() + j * c.rows(), a.rows());
  return c;
}

GONIO_INLINE Eigen::MatrixXd thin_transposed_product(const matrix_view& a, const matrix_view& b) {
  Eigen::MatrixXd c(a.cols(), b.cols());
  for (Eigen::Index j = 0; j < b.cols(); ++j)
    for (Eigen::Index i = 0; i < a.cols(); ++i)
      c(i, j) = dot(a.data() + i * a.outerStride(), b.data() + j * b.outerStride(), a.rows());
  return c;
}

}  // namespace gonio
