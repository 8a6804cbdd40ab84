#pragma once
/// Bodies of solve/semidefinite.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/semidefinite.hpp>

#include <Eigen/Cholesky>

namespace gonio {

GONIO_INLINE Eigen::MatrixXd solve_semidefinite(const matrix_view& a, const matrix_view& b) {
  return Eigen::LDLT<Eigen::MatrixXd>(a).solve(b);
}

}  // namespace gonio
