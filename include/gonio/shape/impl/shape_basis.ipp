#pragma once
/// Bodies of shape/shape_basis.hpp.

#include <gonio/basis/learn_pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/shape/shape_basis.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE shape_set shape_set::of(const std::vector<point_columns>& shapes, std::vector<std::string> names) {
  if (shapes.empty() || shapes.size() != names.size() || shapes[0].cols() == 0)
    throw error("a set of shapes needs at least one, of at least one vertex, and a name for each: not " +
                std::to_string(shapes.size()) + " shapes and " + std::to_string(names.size()) + " names");
  const Eigen::Index vertices = shapes[0].cols();
  shape_set set{{static_cast<std::size_t>(vertices)},
                std::move(names),
                cell_matrix(3 * vertices, static_cast<Eigen::Index>(shapes.size()))};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].cols() != vertices)
      throw error("shape '" + set.names[i] + "' has " + std::to_string(shapes[i].cols()) + " vertices, expected " +
                  std::to_string(vertices) + " as '" + set.names[0] + "' has");
    if (!shapes[i].allFinite()) throw error("shape '" + set.names[i] + "' has a vertex that is not finite");
    set.values.col(static_cast<Eigen::Index>(i)) = shapes[i].reshaped().cast<float>();
  }
  return set;
}

GONIO_INLINE point_columns mean_shape(const shape_basis& basis) {
  return Eigen::Map<const Eigen::Matrix3Xf>(basis.mean().data(), 3, static_cast<Eigen::Index>(basis.mean().size() / 3))
      .cast<double>();
}

GONIO_INLINE point_columns shape_of(const shape_basis& basis, const Eigen::VectorXd& weights) {
  const Eigen::VectorXf offsets = basis.components() * weights.cast<float>();
  return mean_shape(basis) + Eigen::Map<const Eigen::Matrix3Xf>(offsets.data(), 3, offsets.size() / 3).cast<double>();
}

GONIO_INLINE shape_basis explaining(const shape_basis& basis, double share) {
  if (!(share > 0.0 && share <= 1.0))
    throw error("the explained variance must be above 0 and at most 1, not " + std::to_string(share));
  const Eigen::VectorXd& sigma = basis.singular_values();
  const double enough = share * sigma.squaredNorm() * (1.0 - 1e-12);
  std::size_t kept = 0;
  for (double sum = 0.0; kept < basis.size() && sum < enough; ++kept)
    sum += sigma[static_cast<Eigen::Index>(kept)] * sigma[static_cast<Eigen::Index>(kept)];
  return basis.truncated(kept);
}

GONIO_INLINE shape_basis with_motion(const shape_basis& basis, const point_columns& shape, double freedom) {
  if (shape.size() != basis.components().rows())
    throw error("a shape of " + std::to_string(shape.cols()) + " vertices is to move with a basis of " +
                std::to_string(basis.components().rows() / 3));
  const auto k = static_cast<Eigen::Index>(basis.size());
  const Eigen::Vector3d centroid = shape.rowwise().mean();
  cell_matrix functions(basis.components().rows(), k + motions);
  functions.leftCols(k) = basis.components();
  for (Eigen::Index vertex = 0; vertex < shape.cols(); ++vertex) {
    const Eigen::Vector3f arm = (shape.col(vertex) - centroid).cast<float>();
    auto rows = functions.block<3, 6>(3 * vertex, k);
    rows << 0, arm.z(), -arm.y(), 1, 0, 0,  // turn x arm, and the shift
        -arm.z(), 0, arm.x(), 0, 1, 0,      //
        arm.y(), -arm.x(), 0, 0, 0, 1;
    rows *= static_cast<float>(freedom);
  }
  Eigen::VectorXd singular_values(k + motions);
  singular_values << basis.singular_values(), functions.rightCols(motions).cast<double>().colwise().norm().transpose();
  Eigen::MatrixXf coefficients = Eigen::MatrixXf::Zero(basis.coefficients().rows(), k + motions);
  coefficients.leftCols(k) = basis.coefficients();
  return shape_basis({basis.cells(), basis.metric(), basis.names(), std::move(singular_values), std::move(functions),
                      basis.mean(), std::move(coefficients), basis.explained_variance(), basis.source()});
}

}  // namespace gonio
