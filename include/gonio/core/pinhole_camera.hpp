#pragma once
/// A pinhole camera: the ray of a pixel, and the pixel of a point. Without lens distortion: undistort images first.
///
/// Conventions, those of OpenCV: the camera looks along its z axis, x to the right and y downwards in the image;
/// pixel (row, column) covers columns from `column` to `column + 1`, so its centre is at `column + 0.5`.

#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

namespace gonio {

/// A half line.
struct ray {
  Eigen::Vector3d origin;
  direction towards;  ///< of length 1

  /// Where it meets the plane z = 0, if it comes from above.
  [[nodiscard]] std::optional<Eigen::Vector3d> at_ground() const noexcept {
    if (!(origin.z() > 0.0 && towards.z() < 0.0)) return {};
    Eigen::Vector3d point = origin - towards * (origin.z() / towards.z());
    point.z() = 0.0;
    return point;
  }
};

/// What the lens and the sensor do, in pixels.
struct camera_intrinsics {
  std::size_t rows = 0, columns = 0;
  double focal_length_x = 0.0, focal_length_y = 0.0;
  double principal_x = 0.0, principal_y = 0.0;  ///< where the optical axis meets the image

  /// A square image of so many pixels a side that spans an angle in radians from its left to its right.
  [[nodiscard]] static camera_intrinsics square(std::size_t pixels, double field_of_view);
};

/// A camera at a place, in any unit of length that the scene is in.
class pinhole_camera {
 public:
  /// `rotation` takes directions of the world to those of the camera: its rows are the camera's axes. Throws
  /// gonio::error unless it is a rotation (to 1e-3, what a file with four decimals has), the focal lengths are
  /// positive, there are pixels and all is finite.
  pinhole_camera(const camera_intrinsics& intrinsics, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& position);

  /// A camera that looks at a target, the upper edge of its image towards `up`. Throws gonio::error if it is at the
  /// target or looks along `up`.
  [[nodiscard]] static pinhole_camera look_at(const camera_intrinsics& intrinsics, const Eigen::Vector3d& position,
                                              const Eigen::Vector3d& target, const Eigen::Vector3d& up);

  [[nodiscard]] const camera_intrinsics& intrinsics() const noexcept { return intrinsics_; }
  [[nodiscard]] const Eigen::Matrix3d& rotation() const noexcept { return rotation_; }
  [[nodiscard]] const Eigen::Vector3d& position() const noexcept { return position_; }

  /// What is seen at a place of the image; pixel centres are at halves.
  [[nodiscard]] ray ray_through(double column, double row) const noexcept {
    const Eigen::Vector3d seen((column - intrinsics_.principal_x) / intrinsics_.focal_length_x,
                               (row - intrinsics_.principal_y) / intrinsics_.focal_length_y, 1.0);
    return {position_, (rotation_.transpose() * seen).normalized()};
  }

  /// (column, row) at which a point is seen, inside the image or not; nothing if it is not before the camera.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const noexcept {
    const Eigen::Vector3d seen = rotation_ * (point - position_);
    if (!(seen.z() > 0.0)) return {};
    return Eigen::Vector2d(intrinsics_.principal_x + intrinsics_.focal_length_x * seen.x() / seen.z(),
                           intrinsics_.principal_y + intrinsics_.focal_length_y * seen.y() / seen.z());
  }

 private:
  camera_intrinsics intrinsics_;
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d position_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/pinhole_camera.ipp>
#endif
