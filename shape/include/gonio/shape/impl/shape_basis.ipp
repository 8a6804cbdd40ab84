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
#include <string>
#include <utility>
#include <vector>

namespace gonio::shape {

GONIO_INLINE shape_set shape_set::of(const std::vector<point_columns>& shapes, std::vector<std::string> names) {
  if (shapes.empty() || shapes.size() != names.size() || shapes[0].cols() == 0)
    refuse({"a set of shapes needs at least one shape of at least one vertex, and a name for each, not ", shapes.size(),
            " shapes and ", names.size(), " names"});
  const Eigen::Index vertices = shapes[0].cols();
  shape_set set{{vertices}, std::move(names), cell_matrix(3 * vertices, std::ssize(shapes))};
  for (Eigen::Index i = 0; i < std::ssize(shapes); ++i) {
    if (shapes[i].cols() != vertices)
      refuse({"shape '", set.names[i], "' has ", shapes[i].cols(), " vertices, expected ", vertices, " as '",
              set.names[0], "' has"});
    if (!shapes[i].allFinite()) refuse({"shape '", set.names[i], "' has a vertex that is not finite"});
    for (Eigen::Index row = 0; row < set.values.rows(); ++row)
      set.values(row, i) = static_cast<float>(shapes[i].data()[row]);
  }
  return set;
}

GONIO_INLINE point_columns mean_shape(const shape_basis& basis) {
  const std::vector<float>& mean = basis.mean();
  point_columns shape(3, mean.size() / 3);
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
  Eigen::Index kept = 0;
  for (double sum = 0.0; kept < basis.size() && sum < enough; ++kept) sum += sigma[kept] * sigma[kept];
  return basis.truncated(kept);
}

}  // namespace gonio::shape
