#pragma once
/// The image position at which a mirror sphere shows light from a direction (P. Debevec, "Rendering Synthetic Objects
/// into Real Scenes", SIGGRAPH 1998, doi:10.1145/280814.280864; Nielsen's thesis 2016, note on environment maps, Eq.
/// 1-3). capture/light_probe.hpp converts photographs to maps of the light.

#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

namespace gonio::capture {

/// A mirror sphere and a camera that looks at its centre. Axes: x to the right and y up in the image, z from the sphere
/// towards the camera. The sphere fills the image; image coordinates are from -1 to 1, with y upwards.
class mirror_sphere {
 public:
  /// A camera at infinity: orthographic, as the note assumes.
  mirror_sphere() = default;

  /// Takes the camera's distance from the centre, in radii of the sphere. Throws gonio::error unless it is more than 1.
  explicit mirror_sphere(double distance);

  /// Returns the sphere for a camera from which it subtends this angle in radians. Throws gonio::error unless the angle
  /// is between 0 and pi.
  [[nodiscard]] static mirror_sphere spanning(double angle);

  [[nodiscard]] double distance() const noexcept { return distance_; }

  /// Returns the largest angle in radians between the z axis and a light that the camera sees. For a camera at infinity
  /// it is pi; light from directly behind the sphere is spread around its rim. For a close camera, it is smaller,
  /// because the sphere hides the light behind it.
  [[nodiscard]] double largest_polar_angle() const noexcept { return std::numbers::pi - std::asin(1.0 / distance_); }

  /// Returns the image position of light from a direction, which need not be of unit length. Returns nothing if the
  /// sphere hides the light. Uses about five steps of Newton's method in the plane of light, normal and camera.
  [[nodiscard]] std::optional<Eigen::Vector2d> position_of(const direction& light) const noexcept;

  /// Returns the direction of the light seen at an image position, a unit vector; nothing outside the sphere.
  [[nodiscard]] std::optional<direction> light_at(const Eigen::Vector2d& position) const noexcept;

  /// Returns how far the image position moves per radian of the light's polar angle, in radii of the sphere: 1/2 in the
  /// middle for a camera at infinity, and 0 at the rim and for light that the sphere hides. Across this direction the
  /// image is never coarser.
  [[nodiscard]] double resolution(double polar) const noexcept;

 private:
  [[nodiscard]] bool is_far() const noexcept { return std::isinf(distance_); }

  /// Returns the angle between the z axis and the line from a point of the sphere to the camera. `angle` is the angle
  /// between z and the normal at this point; the line leans to the other side of z.
  [[nodiscard]] double leaning(double angle) const noexcept {
    return is_far() ? 0.0 : std::atan2(std::sin(angle), distance_ - std::cos(angle));
  }

  /// Returns the angle between z and the normal that reflects light at a polar angle to the camera: the solution a of 2
  /// a + leaning(a) = polar. The left side of the equation increases with a.
  [[nodiscard]] double normal_angle(double polar) const noexcept;

  /// Returns the derivative of the light's polar angle, 2 a + leaning(a), with respect to the normal's angle a.
  [[nodiscard]] double polar_slope(double angle) const noexcept {
    if (is_far()) return 2.0;
    const double cosine = std::cos(angle);
    return 2.0 + (distance_ * cosine - 1.0) / (distance_ * distance_ - 2.0 * distance_ * cosine + 1.0);
  }

  /// Returns the distance from the image centre of the point whose normal is at an angle from z.
  [[nodiscard]] double radius_of(double angle) const noexcept {
    if (is_far()) return std::sin(angle);
    return std::min(1.0, std::sin(angle) / (distance_ - std::cos(angle)) * std::sqrt(distance_ * distance_ - 1.0));
  }

  /// Returns the angle between z and the normal at an image position, which is at `radius` from the image centre: the
  /// inverse of `radius_of`, for the side of the sphere that faces the camera.
  [[nodiscard]] double angle_of(double radius) const noexcept;

  double distance_ = std::numeric_limits<double>::infinity();
};

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/mirror_sphere.ipp>
#endif
