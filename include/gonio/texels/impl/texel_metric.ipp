#pragma once
/// Bodies of texels/texel_metric.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/symmetric_eigen.hpp>
#include <gonio/texels/texel_metric.hpp>

#include <Eigen/Core>

namespace gonio {

GONIO_INLINE Eigen::MatrixXf texel_metric(const log_relative_pca& prior, const Eigen::MatrixXf& functions) {
  const Eigen::Index k = prior.size();
  if (functions.rows() != k) refuse({"functions of ", functions.rows(), " components, expected ", k});
  const Eigen::MatrixXd scaled = prior.singular_values().asDiagonal() * functions.cast<double>();
  const symmetric_eigen found =
      decompose_symmetric(product_with_transpose(scaled.transpose()), "the products of the functions");
  const double values = 3.0 * static_cast<double>(prior.cells().size());
  const Eigen::VectorXd scales = (found.values.array().max(0.0) / values).sqrt();
  return (scales.asDiagonal() * found.vectors.transpose()).colwise().reverse().cast<float>();
}

}  // namespace gonio
