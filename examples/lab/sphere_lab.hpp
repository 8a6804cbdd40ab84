#pragma once
/// A simulated laboratory for photographs of a sphere: a lens camera at a finite distance with vignetting, a point
/// lamp, and noise.

#include "white_material.hpp"
#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/surface_photograph.hpp>
#include <gonio/core/brdf.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>

namespace lab {

/// The defects of a camera.
struct camera_defects {
  double noise = 0.0;       ///< relative standard deviation, for each channel of each pixel
  double background = 0.0;  ///< standard deviation of the dark background, in the unit of radiance
  bool vignetting = false;  ///< by the fourth power of the cosine to the axis, and by another 40 % at the corners
};

/// Returns the radiance along a ray from a sphere under a lamp; nothing if the ray misses the sphere.
template <gonio::brdf Brdf>
[[nodiscard]] std::optional<gonio::rgb> radiance_along(const gonio::ray& line, const Brdf& material,
                                                       const gonio::capture::placed_sphere& sphere,
                                                       const gonio::capture::point_lamp& lamp) {
  const Eigen::Vector3d from = line.origin - sphere.centre;
  const double half = from.dot(line.towards);
  const double inside = half * half - from.squaredNorm() + sphere.radius * sphere.radius;
  if (!(inside > 0.0 && half < 0.0)) return {};
  const Eigen::Vector3d point = line.origin + line.towards * (-half - std::sqrt(inside));
  const Eigen::Vector3d normal = (point - sphere.centre).normalized(), away = lamp.position - point;
  const Eigen::Vector3d x = normal.unitOrthogonal(), y = normal.cross(x), light = away.normalized();
  const auto local = [&](const Eigen::Vector3d& w) { return gonio::direction(x.dot(w), y.dot(w), normal.dot(w)); };
  const gonio::direction wi = local(light), wo = local(-line.towards);
  if (!(wi.z() > 0.0)) return gonio::rgb::Zero();
  return gonio::rgb(gonio::rgb(material(wi, wo)) * lamp.intensity * (wi.z() / away.squaredNorm()));
}

/// Returns the camera's transmission at an image position.
[[nodiscard]] inline double transmission(const gonio::lens_camera& camera, double column, double row) {
  const gonio::camera_intrinsics& size = camera.intrinsics();
  const Eigen::Vector2d off((column - size.principal_x) / static_cast<double>(size.columns),
                            (row - size.principal_y) / static_cast<double>(size.rows));
  const double cosine = (camera.pinhole().rotation() * camera.ray_through(column, row).towards).z();
  return std::pow(cosine, 4) * (1.0 - 0.8 * off.squaredNorm());
}

/// Returns a photograph of a sphere of the material on a dark ground; each pixel is the mean of 4 x 4 rays. The seed
/// determines the defects.
template <gonio::brdf Brdf>
[[nodiscard]] gonio::image photograph(const Brdf& material, const gonio::capture::placed_sphere& sphere,
                                      const gonio::lens_camera& camera, const gonio::capture::point_lamp& lamp,
                                      const camera_defects& defects = {}, std::uint64_t seed = 0) {
  constexpr int across = 4;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const gonio::camera_intrinsics& size = camera.intrinsics();
  gonio::image image = gonio::uniform_image(size.rows, size.columns);
  for (std::size_t row = 0; row < size.rows; ++row)
    for (std::size_t column = 0; column < size.columns; ++column) {
      gonio::rgb sum = gonio::rgb::Zero();
      for (int i = 0; i < across * across; ++i) {
        const double x = static_cast<double>(column) + (i % across + 0.5) / across,
                     y = static_cast<double>(row) + (i / across + 0.5) / across;
        const auto radiance = radiance_along(camera.ray_through(x, y), material, sphere, lamp);
        if (radiance) sum += *radiance * (defects.vignetting ? transmission(camera, x, y) : 1.0);
      }
      gonio::rgb value = sum / (across * across);
      for (double& channel : value)
        channel = channel * (1.0 + defects.noise * normal(generator)) + defects.background * normal(generator);
      gonio::set_pixel(image, row, column, value.max(0.0));
    }
  return image;
}

}  // namespace lab
