#pragma once
/// Bodies of shape/shape_basis.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/shape_basis.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace gonio::shape {

GONIO_INLINE shape_set shape_set::of(const std::vector<point_columns>& shapes, std::vector<std::string> names) {
  if (shapes.empty() || shapes.size() != names.size() || shapes[0].cols() == 0)
    refuse({"a set of shapes needs at least one, of at least one vertex, and a name for each: not ", shapes.size(),
            " shapes and ", names.size(), " names"});
  const Eigen::Index vertices = shapes[0].cols();
  shape_set set{{static_cast<std::size_t>(vertices)},
                std::move(names),
                cell_matrix(3 * vertices, static_cast<Eigen::Index>(shapes.size()))};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].cols() != vertices)
      refuse({"shape '", set.names[i], "' has ", shapes[i].cols(), " vertices, expected ", vertices, " as '",
              set.names[0], "' has"});
    if (!shapes[i].allFinite()) refuse({"shape '", set.names[i], "' has a vertex that is not finite"});
    for (Eigen::Index row = 0; row < set.values.rows(); ++row)
      set.values(row, static_cast<Eigen::Index>(i)) = static_cast<float>(shapes[i].data()[row]);
  }
  return set;
}

GONIO_INLINE point_columns mean_shape(const shape_basis& basis) {
  const std::vector<float>& mean = basis.mean();
  point_columns shape(3, static_cast<Eigen::Index>(mean.size() / 3));
  std::ranges::copy(mean, shape.data());
  return shape;
}

GONIO_INLINE point_columns shape_of(const shape_basis& basis, const Eigen::VectorXd& weights) {
  const cell_matrix& functions = basis.components();
  const Eigen::VectorXf shares = weights.cast<float>();
  point_columns shape = mean_shape(basis);
  for (Eigen::Index row = 0; row < functions.rows(); ++row) shape.data()[row] += double{functions.row(row).dot(shares)};
  return shape;
}

GONIO_INLINE double squared_mahalanobis(const shape_basis& basis, const Eigen::VectorXd& weights) {
  return static_cast<double>(basis.names().size()) * weights.squaredNorm();
}

GONIO_INLINE shape_basis truncated_to_variance(const shape_basis& basis, double share) {
  if (!(share > 0.0 && share <= 1.0)) refuse({"the explained variance must be above 0 and at most 1, not ", share});
  const Eigen::VectorXd& sigma = basis.singular_values();
  const double enough = share * sigma.squaredNorm() * (1.0 - 1e-12);
  std::size_t kept = 0;
  for (double sum = 0.0; kept < basis.size() && sum < enough; ++kept)
    sum += sigma[static_cast<Eigen::Index>(kept)] * sigma[static_cast<Eigen::Index>(kept)];
  return basis.truncated(kept);
}

GONIO_INLINE shape_basis with_motion(const shape_basis& basis, const point_columns& shape, double freedom) {
  if (shape.size() != basis.components().rows())
    refuse({"a shape of ", shape.cols(), " vertices is to move with a basis of ", basis.components().rows() / 3});
  const auto k = static_cast<Eigen::Index>(basis.size());
  const Eigen::Vector3d centroid = centroid_of(shape);
  cell_matrix functions(basis.components().rows(), k + motions);
  functions.leftCols(k) = basis.components();
  const auto scale = static_cast<float>(freedom);
  for (Eigen::Index vertex = 0; vertex < shape.cols(); ++vertex) {
    std::array<float, 3> arm{};
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      arm[static_cast<std::size_t>(axis)] = static_cast<float>(shape(axis, vertex) - centroid[axis]);
    // turn x arm, and the shift
    const std::array<std::array<float, motions>, 3> moved{
        {{0, arm[2], -arm[1], 1, 0, 0}, {-arm[2], 0, arm[0], 0, 1, 0}, {arm[1], -arm[0], 0, 0, 0, 1}}};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t motion = 0; motion < motions; ++motion)
        functions(3 * vertex + static_cast<Eigen::Index>(axis), k + static_cast<Eigen::Index>(motion)) =
            scale * moved[axis][motion];
  }
  Eigen::VectorXd singular_values = Eigen::VectorXd::Zero(k + motions);
  singular_values.head(k) = basis.singular_values();
  for (Eigen::Index motion = k; motion < k + motions; ++motion) {
    double sum = 0.0;
    for (Eigen::Index row = 0; row < functions.rows(); ++row) {
      const double value = functions(row, motion);
      sum += value * value;
    }
    singular_values[motion] = std::sqrt(sum);
  }
  Eigen::MatrixXf coefficients = Eigen::MatrixXf::Zero(basis.coefficients().rows(), k + motions);
  coefficients.leftCols(k) = basis.coefficients();
  return shape_basis({basis.cells(), basis.metric(), basis.names(), std::move(singular_values), std::move(functions),
                      basis.mean(), std::move(coefficients), basis.explained_variance(), basis.source()});
}

}  // namespace gonio::shape
