#pragma once
/// Bodies of shape/shape_uncertainty.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/shape/confidence.hpp>
#include <gonio/shape/fitted_shape.hpp>
#include <gonio/shape/shape_uncertainty.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace gonio {

GONIO_INLINE double shape_uncertainty::squared_radius(double share) const {
  const double left = degrees_of_freedom_ - 2.0;
  return 3.0 * degrees_of_freedom_ / left * f_quantile(share, 3.0, left);
}

GONIO_INLINE Eigen::Matrix3d shape_uncertainty::unscaled(Eigen::Index vertex) const {
  const Eigen::MatrixXd rows = basis_.components().middleRows(3 * vertex, 3).cast<double>();
  return rows * unseen_ * rows.transpose();
}

}  // namespace gonio
