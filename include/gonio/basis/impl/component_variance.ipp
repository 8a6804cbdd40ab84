#pragma once
/// Bodies of basis/component_variance.hpp.

#include <gonio/basis/component_variance.hpp>
#include <gonio/core/compiled.hpp>

#include <Eigen/Core>

#include <cmath>

namespace gonio {

GONIO_INLINE Eigen::VectorXd weight_deviations(const Eigen::MatrixXf& coefficients) {
  Eigen::VectorXd deviations(coefficients.cols());
  const auto count = static_cast<double>(coefficients.rows());
  for (Eigen::Index j = 0; j < coefficients.cols(); ++j) {
    double sum = 0.0, squares = 0.0;
    for (Eigen::Index i = 0; i < coefficients.rows(); ++i) sum += double{coefficients(i, j)};
    for (Eigen::Index i = 0; i < coefficients.rows(); ++i) {
      const double difference = double{coefficients(i, j)} - sum / count;
      squares += difference * difference;
    }
    deviations[j] = std::sqrt(squares / count);
  }
  return deviations;
}

}  // namespace gonio
