#pragma once
/// Bodies of core/pinhole_camera.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/pinhole_camera.hpp>
#include <gonio/core/rotation.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

namespace gonio {

GONIO_INLINE camera_intrinsics camera_intrinsics::square(std::size_t pixels, double field_of_view) {
  const double half = static_cast<double>(pixels) / 2.0, focal_length = half / std::tan(field_of_view / 2.0);
  return {pixels, pixels, focal_length, focal_length, half, half};
}

GONIO_INLINE pinhole_camera::pinhole_camera(const camera_intrinsics& intrinsics, const Eigen::Matrix3d& rotation,
                                            const Eigen::Vector3d& position)
    : intrinsics_(intrinsics), rotation_(rotation), position_(position) {
  if (intrinsics.rows == 0 || intrinsics.columns == 0) refuse("a camera needs pixels");
  const Eigen::Vector4d numbers(intrinsics.focal_length_x, intrinsics.focal_length_y, intrinsics.principal_x,
                                intrinsics.principal_y);
  if (!numbers.allFinite() || !position.allFinite()) refuse("a camera's intrinsics and position must be finite");
  if (!(intrinsics.focal_length_x > 0.0 && intrinsics.focal_length_y > 0.0))
    refuse({"a camera's focal lengths must be positive, not ", intrinsics.focal_length_x, " and ",
            intrinsics.focal_length_y});
  if (!is_rotation(rotation)) refuse("a camera's rotation must be an orthogonal matrix of determinant 1");
}

GONIO_INLINE pinhole_camera pinhole_camera::look_at(const camera_intrinsics& intrinsics,
                                                    const Eigen::Vector3d& position, const Eigen::Vector3d& target,
                                                    const Eigen::Vector3d& up) {
  const Eigen::Vector3d forward = target - position, right = forward.cross(up);
  if (!(right.norm() > 1e-9 * forward.norm() * up.norm()))
    refuse("a camera's target must differ from its position, and its upward direction from its viewing direction");
  Eigen::Matrix3d rotation;
  rotation.row(0) = right.normalized();
  rotation.row(2) = forward.normalized();
  rotation.row(1) = rotation.row(2).cross(rotation.row(0));
  return {intrinsics, rotation, position};
}

}  // namespace gonio
