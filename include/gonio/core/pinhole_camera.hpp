#pragma once
/// A pinhole camera: the ray of a pixel, and the pixel of a point. Has no lens distortion: undistort images first.
///
/// Conventions of OpenCV: the camera looks along its z axis, with x to the right and y downwards in the image. Pixel
/// (row, column) covers columns from `column` to `column + 1`, so its centre is at `column + 0.5`.

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

  /// Returns the intersection with the plane z = 0, if the ray comes from above.
  [[nodiscard]] std::optional<Eigen::Vector3d> at_ground() const noexcept {
    if (!(origin.z() > 0.0 && towards.z() < 0.0)) return {};
    Eigen::Vector3d point = origin - towards * (origin.z() / towards.z());
    point.z() = 0.0;
    return point;
  }
};

/// Parameters of lens and sensor, in pixels.
struct camera_intrinsics {
  std::size_t rows = 0, columns = 0;
  double focal_length_x = 0.0, focal_length_y = 0.0;
  double principal_x = 0.0, principal_y = 0.0;  ///< the intersection of the optical axis with the image

  /// Returns the parameters for a square image with this many pixels per side, whose width spans an angle in radians.
  [[nodiscard]] static camera_intrinsics square(std::size_t pixels, double field_of_view);
};

/// A camera at a position, in any unit of length of the scene.
class pinhole_camera {
 public:
  /// `rotation` maps directions of the world to those of the camera: its rows are the camera's axes. Throws
  /// gonio::error unless it is a rotation (to 1e-3, the precision of a file with four decimals), the focal lengths are
  /// positive, there are pixels, and all numbers are finite.
  pinhole_camera(const camera_intrinsics& intrinsics, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& position);

  /// Returns a camera that looks at a target, with the upper edge of its image towards `up`. Throws gonio::error if the
  /// camera is at the target or looks along `up`.
  [[nodiscard]] static pinhole_camera look_at(const camera_intrinsics& intrinsics, const Eigen::Vector3d& position,
                                              const Eigen::Vector3d& target, const Eigen::Vector3d& up);

  [[nodiscard]] const camera_intrinsics& intrinsics() const noexcept { return intrinsics_; }
  [[nodiscard]] const Eigen::Matrix3d& rotation() const noexcept { return rotation_; }
  [[nodiscard]] const Eigen::Vector3d& position() const noexcept { return position_; }

  /// Returns the ray through a location of the image; pixel centres are at 0.5, 1.5 and so on.
  [[nodiscard]] ray ray_through(double column, double row) const noexcept {
    const Eigen::Vector3d seen((column - intrinsics_.principal_x) / intrinsics_.focal_length_x,
                               (row - intrinsics_.principal_y) / intrinsics_.focal_length_y, 1.0);
    return {position_, (rotation_.transpose() * seen).normalized()};
  }

  /// Returns the (column, row) at which a point is seen, inside or outside of the image; nothing if the point is behind
  /// the camera.
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
