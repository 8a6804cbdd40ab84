#pragma once
/// The distortion of a lens, and a camera that has one: D. C. Brown, "Decentering Distortion of Lenses", 1966, and
/// A. E. Conrady 1919 (doi:10.1093/mnras/79.5.384), with the names and the order of OpenCV's coefficients.
///
/// (x, y) is where a pinhole of focal length 1 sees a point, r its distance from the axis. The lens shows it at
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

  /// Where the lens shows a point that a pinhole of focal length 1 sees here.
  [[nodiscard]] Eigen::Vector2d distorted(const Eigen::Vector2d& ideal) const noexcept;

  /// How `distorted` changes with its argument.
  [[nodiscard]] Eigen::Matrix2d jacobian(const Eigen::Vector2d& ideal) const noexcept;

  /// The radial part alone: r (1 + k1 r^2 + k2 r^4 + k3 r^6), and its derivative.
  [[nodiscard]] double distorted_radius(double r) const noexcept;
  [[nodiscard]] double radius_derivative(double r) const noexcept;
};

/// A pinhole camera behind a lens with distortion. Within the image each pixel has one ray.
///
/// ```cpp
/// const gonio::lens_camera camera(pinhole, {.k1 = -0.2, .k2 = 0.05});
/// const gonio::ray line = camera.ray_through(320.5, 240.5);
/// ```
class lens_camera {
 public:
  /// Throws gonio::error if a coefficient is not finite, or if the distortion folds within the image, naming the
  /// radius at which it turns back.
  lens_camera(const pinhole_camera& pinhole, const lens_distortion& distortion = {});  // NOLINT: a pinhole is one

  [[nodiscard]] const pinhole_camera& pinhole() const noexcept { return pinhole_; }
  [[nodiscard]] const lens_distortion& distortion() const noexcept { return distortion_; }
  [[nodiscard]] const camera_intrinsics& intrinsics() const noexcept { return pinhole_.intrinsics(); }
  [[nodiscard]] const Eigen::Vector3d& position() const noexcept { return pinhole_.position(); }

  /// What is seen at a place of the image; pixel centres are at halves. Places beside the image get the ray of the
  /// pinhole where the distortion folds before them. Newton's method: five steps or so.
  [[nodiscard]] ray ray_through(double column, double row) const noexcept;

  /// (column, row) at which a point is seen; nothing if it is not before the camera, or farther from the axis than the
  /// image's corners.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const noexcept;

  /// Radians that a pixel in the middle of the image spans.
  [[nodiscard]] double pixel_angle() const noexcept;

 private:
  [[nodiscard]] std::optional<Eigen::Vector2d> undistorted(const Eigen::Vector2d& shown) const noexcept;
  [[nodiscard]] Eigen::Vector2d shown_at(double column, double row) const noexcept;
  [[nodiscard]] double farthest_corner() const noexcept;
  void require_monotone_radius();
  void require_one_ray_each() const;

  pinhole_camera pinhole_;
  lens_distortion distortion_;
  double largest_radius_ = 0.0;  ///< of the ideal places that the image shows, by the radial part
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/lens_distortion.ipp>
#endif
