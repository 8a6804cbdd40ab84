#pragma once
/// Bodies of core/lens_distortion.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/core/pinhole_camera.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace gonio {

GONIO_INLINE Eigen::Vector2d lens_distortion::distorted(const Eigen::Vector2d& ideal) const noexcept {
  const double x = ideal.x(), y = ideal.y(), s = x * x + y * y;
  const double radial = 1.0 + s * (k1 + s * (k2 + s * k3));
  return {x * radial + 2.0 * p1 * x * y + p2 * (s + 2.0 * x * x),
          y * radial + p1 * (s + 2.0 * y * y) + 2.0 * p2 * x * y};
}

GONIO_INLINE Eigen::Matrix2d lens_distortion::jacobian(const Eigen::Vector2d& ideal) const noexcept {
  const double x = ideal.x(), y = ideal.y(), s = x * x + y * y;
  const double radial = 1.0 + s * (k1 + s * (k2 + s * k3)), slope = 2.0 * (k1 + s * (2.0 * k2 + s * 3.0 * k3));
  const double mixed = x * y * slope + 2.0 * (p1 * x + p2 * y);
  Eigen::Matrix2d all;
  all << radial + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, mixed,  //
      mixed, radial + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
  return all;
}

GONIO_INLINE double lens_distortion::distorted_radius(double r) const noexcept {
  const double s = r * r;
  return r * (1.0 + s * (k1 + s * (k2 + s * k3)));
}

GONIO_INLINE double lens_distortion::radius_derivative(double r) const noexcept {
  const double s = r * r;
  return 1.0 + s * (3.0 * k1 + s * (5.0 * k2 + s * 7.0 * k3));
}

GONIO_INLINE lens_camera::lens_camera(const pinhole_camera& pinhole, const lens_distortion& distortion)
    : pinhole_(pinhole), distortion_(distortion) {
  for (const double each : {distortion.k1, distortion.k2, distortion.p1, distortion.p2, distortion.k3})
    if (!std::isfinite(each)) refuse("the coefficients of a lens distortion must be finite");
  largest_radius_ = farthest_corner();
  if (distortion_.is_none()) return;
  require_monotone_radius();
  require_one_ray_each();
}

GONIO_INLINE Eigen::Vector2d lens_camera::shown_at(double column, double row) const noexcept {
  const camera_intrinsics& in = intrinsics();
  return {(column - in.principal_x) / in.focal_length_x, (row - in.principal_y) / in.focal_length_y};
}

GONIO_INLINE double lens_camera::farthest_corner() const noexcept {
  const auto columns = static_cast<double>(intrinsics().columns), rows = static_cast<double>(intrinsics().rows);
  double farthest = 0.0;
  for (const double column : {0.0, columns})
    for (const double row : {0.0, rows}) farthest = std::max(farthest, shown_at(column, row).norm());
  return farthest;
}

/// Finds `largest_radius_`: increases the undistorted radius until its image reaches the farthest corner. Refuses the
/// distortion if the image's radius stops growing before.
GONIO_INLINE void lens_camera::require_monotone_radius() {
  const double corner = farthest_corner();
  const double tangential = 3.0 * (std::abs(distortion_.p1) + std::abs(distortion_.p2));
  double r = 0.0;
  for (double step = corner / 2000.0; distortion_.distorted_radius(r) < corner + tangential * r * r;
       step *= r > 2.0 * corner ? 1.01 : 1.0) {
    r += step;
    if (distortion_.radius_derivative(r) > 0.0 && r < 1000.0 * corner) continue;
    refuse({"the lens distortion folds within the image: at a radius of ", r,
            " focal lengths the distorted radius stops growing, at ", distortion_.distorted_radius(r),
            ", but the farthest corner is at ", corner});
  }
  largest_radius_ = r;
}

/// Refuses folds that the tangential coefficients cause.
GONIO_INLINE void lens_camera::require_one_ray_each() const {
  constexpr int steps = 24;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j) {
      const Eigen::Vector2d shown = shown_at(static_cast<double>(intrinsics().columns) * j / steps,
                                             static_cast<double>(intrinsics().rows) * i / steps);
      const auto ideal = undistorted(shown);
      if (ideal && distortion_.jacobian(*ideal).determinant() > 0.0) continue;
      refuse({"the lens distortion folds within the image, at a radius of ", shown.norm(),
              " focal lengths: check its tangential coefficients"});
    }
}

GONIO_INLINE std::optional<Eigen::Vector2d> lens_camera::undistorted(const Eigen::Vector2d& shown) const noexcept {
  if (distortion_.is_none()) return shown;
  // Invert the radial part by bisection, which cannot step over a fold.
  const double radius = shown.norm();
  double low = 0.0, high = largest_radius_;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    (distortion_.distorted_radius(middle) < radius ? low : high) = middle;
  }
  Eigen::Vector2d ideal = radius > 0.0 ? Eigen::Vector2d(shown * (0.5 * (low + high) / radius)) : shown;
  // Add the tangential part by Newton's method.
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d off = distortion_.distorted(ideal) - shown;
    if (off.norm() < 1e-13) return ideal;
    const Eigen::Matrix2d slope = distortion_.jacobian(ideal);
    const double determinant = slope.determinant();
    if (!(determinant > 0.0)) return {};
    ideal -=
        Eigen::Vector2d(slope(1, 1) * off.x() - slope(0, 1) * off.y(), slope(0, 0) * off.y() - slope(1, 0) * off.x()) /
        determinant;
  }
  if ((distortion_.distorted(ideal) - shown).norm() < 1e-9) return ideal;
  return {};
}

GONIO_INLINE ray lens_camera::ray_through(double column, double row) const noexcept {
  const Eigen::Vector2d shown = shown_at(column, row), ideal = undistorted(shown).value_or(shown);
  const Eigen::Vector3d seen(ideal.x(), ideal.y(), 1.0);
  return {position(), (pinhole_.rotation().transpose() * seen).normalized()};
}

GONIO_INLINE std::optional<Eigen::Vector2d> lens_camera::project(const Eigen::Vector3d& point) const noexcept {
  const Eigen::Vector3d seen = pinhole_.rotation() * (point - position());
  if (!(seen.z() > 0.0)) return {};
  const Eigen::Vector2d ideal(seen.x() / seen.z(), seen.y() / seen.z());
  if (!distortion_.is_none() && ideal.norm() > largest_radius_) return {};
  const Eigen::Vector2d shown = distortion_.distorted(ideal);
  const camera_intrinsics& in = intrinsics();
  return Eigen::Vector2d(in.principal_x + in.focal_length_x * shown.x(),
                         in.principal_y + in.focal_length_y * shown.y());
}

GONIO_INLINE double lens_camera::pixel_angle() const noexcept {
  return 2.0 / (intrinsics().focal_length_x + intrinsics().focal_length_y);
}

}  // namespace gonio
