#pragma once
/// Bodies of core/rotation.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/rotation.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

namespace gonio {

GONIO_INLINE bool is_rotation(const Eigen::Matrix3d& matrix) {
  constexpr double tolerance = 1e-3;
  return (matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).norm() < tolerance && matrix.determinant() > 0.0;
}

}  // namespace gonio
