#pragma once
/// Bodies of solve/float_product.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/float_product.hpp>

namespace gonio {

GONIO_INLINE Eigen::MatrixXf product(const float_matrix_view& a, const float_matrix_view& b) {
  Eigen::MatrixXf sum = Eigen::MatrixXf::Zero(a.rows(), b.cols());
  add_product(a, b, sum);
  return sum;
}

GONIO_INLINE void add_product(const float_matrix_view& a, const float_matrix_view& b, float_matrix_block sum) {
  sum.noalias() += a * b;
}

}  // namespace gonio
