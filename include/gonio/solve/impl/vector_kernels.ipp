#pragma once
/// Bodies of solve/vector_kernels.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/vector_kernels.hpp>

#include <Eigen/Core>

namespace gonio {

GONIO_INLINE double dot(const double* a, const double* b, Eigen::Index count) {
  return Eigen::Map<const Eigen::VectorXd>(a, count).dot(Eigen::Map<const Eigen::VectorXd>(b, count));
}

GONIO_INLINE float dot(const float* a, const float* b, Eigen::Index count) {
  return Eigen::Map<const Eigen::VectorXf>(a, count).dot(Eigen::Map<const Eigen::VectorXf>(b, count));
}

GONIO_INLINE void add_scaled(double factor, const double* a, double* sum, Eigen::Index count) {
  Eigen::Map<Eigen::VectorXd>(sum, count) += factor * Eigen::Map<const Eigen::VectorXd>(a, count);
}

}  // namespace gonio
