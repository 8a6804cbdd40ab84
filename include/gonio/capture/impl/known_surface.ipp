#pragma once
/// Bodies of capture/known_surface.hpp.

#include <gonio/capture/known_surface.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/table/surface_image.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

namespace gonio::capture::detail {

/// Fills each pixel with the intersection of its ray. `meet(ray, position, normal)` returns true if there is an
/// intersection.
template <class Meet>
[[nodiscard]] surface_image trace(const lens_camera& camera, const Meet& meet) {
  const camera_intrinsics& size = camera.intrinsics();
  surface_image seen = surface_image::nothing(size.rows, size.columns);
  for (std::size_t row = 0; row < size.rows; ++row)
    for (std::size_t column = 0; column < size.columns; ++column) {
      const ray line = camera.ray_through(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
      Eigen::Vector3d position, normal;
      if (!meet(line, position, normal)) continue;
      seen.positions.col(seen.pixel(row, column)) = position;
      seen.normals.col(seen.pixel(row, column)) = normal;
    }
  return seen;
}

/// Copies a map of vectors. Throws gonio::error if the map has another size, or naming the first pixel that is not
/// finite.
GONIO_INLINE void copy_map(const vector_map& map, const std::string& name, Eigen::Matrix3Xd& onto, std::size_t rows,
                           std::size_t columns) {
  if (map.shape(2) != 3) gonio::refuse({name, ": has ", map.shape(2), " numbers for each pixel, expected 3"});
  if (map.shape(0) != rows || map.shape(1) != columns)
    gonio::refuse(
        {name, ": has ", map.shape(1), " x ", map.shape(0), " pixels, but its camera ", columns, " x ", rows});
  for (Eigen::Index pixel = 0; pixel < onto.cols(); ++pixel)
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double value = map.data()[3 * pixel + axis];
      if (!std::isfinite(value))
        gonio::refuse({name, ": pixel (row ", pixel / static_cast<Eigen::Index>(columns), ", column ",
                       pixel % static_cast<Eigen::Index>(columns), ") is not finite"});
      onto(axis, pixel) = value;
    }
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE surface_image surface_of(const placed_sphere& sphere, const lens_camera& camera) {
  if (!(sphere.radius > 0.0 && std::isfinite(sphere.radius) && sphere.centre.allFinite()))
    refuse("a sphere needs a positive radius and a finite centre");
  const Eigen::Vector3d away = camera.position() - sphere.centre;
  const double beyond = away.squaredNorm() - sphere.radius * sphere.radius;
  if (!(beyond > 0.0)) refuse("the camera is inside the sphere");
  return detail::trace(camera, [&](const ray& line, Eigen::Vector3d& position, Eigen::Vector3d& normal) {
    // Solve |away + t d|^2 = R^2 for t. The camera sees the nearer intersection.
    const double half = away.dot(line.towards), discriminant = half * half - beyond;
    if (!(discriminant > 0.0 && half < 0.0)) return false;
    const double distance = -half - std::sqrt(discriminant);
    position = line.origin + distance * line.towards;
    normal = (position - sphere.centre).normalized();
    return true;
  });
}

GONIO_INLINE surface_image surface_of(const placed_plane& plane, const lens_camera& camera) {
  const double length = plane.normal.norm();
  if (!(length > 0.0 && std::isfinite(length) && plane.point.allFinite()))
    refuse("a plane needs a finite point and a normal that is not 0");
  const Eigen::Vector3d up = plane.normal / length;
  return detail::trace(camera, [&](const ray& line, Eigen::Vector3d& position, Eigen::Vector3d& normal) {
    const double facing = line.towards.dot(up), height = up.dot(line.origin - plane.point);
    if (!(facing < 0.0 && height > 0.0)) return false;
    position = line.origin - line.towards * (height / facing);
    normal = up;
    return true;
  });
}

GONIO_INLINE surface_image surface_of_maps(const vector_map& normals, const std::string& normals_name,
                                           const lens_camera& camera, const std::optional<vector_map>& positions,
                                           const std::string& positions_name) {
  const camera_intrinsics& size = camera.intrinsics();
  surface_image seen = surface_image::nothing(size.rows, size.columns);
  detail::copy_map(normals, normals_name, seen.normals, size.rows, size.columns);
  if (positions) detail::copy_map(*positions, positions_name, seen.positions, size.rows, size.columns);
  bool sees_any = false;
  for (Eigen::Index pixel = 0; pixel < seen.normals.cols(); ++pixel) {
    if (!seen.sees(pixel)) continue;
    seen.normals.col(pixel).normalize();
    sees_any = true;
  }
  if (!sees_any) refuse({normals_name, ": all normals are zero, no pixel sees the surface"});
  return seen;
}

}  // namespace gonio::capture
