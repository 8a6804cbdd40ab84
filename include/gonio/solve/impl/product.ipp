#pragma once
/// Bodies of solve/product.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/product.hpp>

namespace gonio {

GONIO_INLINE Eigen::MatrixXd product(const matrix_view& a, const matrix_view& b) { return a * b; }

GONIO_INLINE void add_product(const matrix_view& a, const matrix_view& b, Eigen::MatrixXd& sum) {
  sum += product(a, b);
}

}  // namespace gonio
