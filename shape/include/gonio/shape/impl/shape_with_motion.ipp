#pragma once
/// Bodies of shape/shape_with_motion.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/shape_with_motion.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <utility>

namespace gonio::shape {

GONIO_INLINE shape_with_motion::shape_with_motion(shape_basis shape, const point_columns& moved, double freedom)
    : shape_(std::move(shape)), centroid_(Eigen::Vector3d::Zero()), freedom_(freedom) {
  const cell_matrix& components = shape_.components();
  if (moved.size() != components.rows())
    refuse({"a shape of ", moved.cols(), " vertices does not match a basis of ", components.rows() / 3});
  centroid_ = centroid_of(moved);
  const Eigen::Index k = shape_.size();
  functions_.resize(components.rows(), k + motions);
  functions_.leftCols(k) = components;
  const auto scale = static_cast<float>(freedom);
  for (Eigen::Index vertex = 0; vertex < moved.cols(); ++vertex) {
    std::array<float, 3> arm{};
    for (Eigen::Index axis = 0; axis < 3; ++axis) arm[axis] = static_cast<float>(moved(axis, vertex) - centroid_[axis]);
    // rotation x arm, and the shift
    const std::array<std::array<float, motions>, 3> displaced{
        {{0, arm[2], -arm[1], 1, 0, 0}, {-arm[2], 0, arm[0], 0, 1, 0}, {arm[1], -arm[0], 0, 0, 0, 1}}};
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      for (Eigen::Index motion = 0; motion < motions; ++motion)
        functions_(3 * vertex + axis, k + motion) = scale * displaced[axis][motion];
  }
}

GONIO_INLINE shape_with_motion::parts shape_with_motion::split(const Eigen::VectorXd& weights) const {
  const Eigen::Index k = shape_.size();
  parts found{weights.head(k), {}};
  Eigen::Vector3d turn, shift;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    turn[axis] = freedom_ * weights[k + axis];
    shift[axis] = freedom_ * weights[k + 3 + axis];
  }
  const double angle = turn.norm();
  if (angle > 0.0) found.motion.rotation = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  found.motion.translation = centroid_ + shift - found.motion.rotation * centroid_;
  return found;
}

}  // namespace gonio::shape
