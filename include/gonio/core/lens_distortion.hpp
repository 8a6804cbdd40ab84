#pragma once
/// The distortion of a lens, and a camera with such a lens: D. C. Brown, "Decentering Distortion of Lenses", 1966, and
/// A. E. Conrady 1919 (doi:10.1093/mnras/79.5.384), with the names and the order of OpenCV's coefficients.
///
/// A pinhole of focal length 1 images a point at (x, y), at the distance r from the axis. The lens images it at
///     x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2),
///     y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y.

#include <gonio/core/error.hpp>
#include <gonio/core/pinhole_camera.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <optional>

namespace gonio {

/// Radial coefficients k and tangential ones p. All zero: no distortion.
struct lens_distortion {
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;

  [[nodiscard]] bool is_none() const noexcept { return k1 == 0.0 && k2 == 0.0 && p1 == 0.0 && p2 == 0.0 && k3 == 0.0; }

  /// Returns the location at which the lens images a point that a pinhole of focal length 1 images at `ideal`.
  [[nodiscard]] Eigen::Vector2d distorted(const Eigen::Vector2d& ideal) const noexcept;

  /// Returns the derivatives of `distorted`.
  [[nodiscard]] Eigen::Matrix2d jacobian(const Eigen::Vector2d& ideal) const noexcept;

  /// Return the distorted radius without the tangential part, r (1 + k1 r^2 + k2 r^4 + k3 r^6), and its derivative.
  [[nodiscard]] double distorted_radius(double r) const noexcept;
  [[nodiscard]] double radius_derivative(double r) const noexcept;
};

/// A pinhole camera with a distorting lens. Within the image each pixel has one ray.
///
/// ```cpp
/// const gonio::lens_camera camera(pinhole, {.k1 = -0.2, .k2 = 0.05});
/// const gonio::ray line = camera.ray_through(320.5, 240.5);
/// ```
class lens_camera {
 public:
  /// Throws gonio::error if a coefficient is not finite, or if the distortion folds within the image. The message
  /// states the radius of the fold.
  lens_camera(const pinhole_camera& pinhole, const lens_distortion& distortion = {});  // NOLINT: implicit

  [[nodiscard]] const pinhole_camera& pinhole() const noexcept { return pinhole_; }
  [[nodiscard]] const lens_distortion& distortion() const noexcept { return distortion_; }
  [[nodiscard]] const camera_intrinsics& intrinsics() const noexcept { return pinhole_.intrinsics(); }
  [[nodiscard]] const Eigen::Vector3d& position() const noexcept { return pinhole_.position(); }

  /// Returns the ray through a location of the image; pixel centres are at 0.5, 1.5 and so on. If the location is
  /// outside of the image and past a fold of the distortion, returns the pinhole's ray. Uses about five steps of
  /// Newton's method.
  [[nodiscard]] ray ray_through(double column, double row) const noexcept;

  /// Returns the (column, row) at which a point is seen; nothing if the point is behind the camera, or farther from the
  /// axis than the corners of the image.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const noexcept;

  /// Returns the angle in radians that a pixel in the centre of the image covers.
  [[nodiscard]] double pixel_angle() const noexcept;

 private:
  [[nodiscard]] std::optional<Eigen::Vector2d> undistorted(const Eigen::Vector2d& shown) const noexcept;
  [[nodiscard]] Eigen::Vector2d shown_at(double column, double row) const noexcept;
  [[nodiscard]] double farthest_corner() const noexcept;
  void require_monotone_radius();
  void require_one_ray_each() const;

  pinhole_camera pinhole_;
  lens_distortion distortion_;
  double largest_radius_ = 0.0;  ///< of undistorted locations within the image, from the radial part alone
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/lens_distortion.ipp>
#endif
