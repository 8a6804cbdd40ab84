#pragma once
/// A simulated light probe: the image of a mirror sphere in an environment.

#include <gonio/capture/light_probe.hpp>
#include <gonio/capture/mirror_sphere.hpp>

namespace lab {

/// How a camera sees the sphere.
struct probe_view {
  std::size_t rows = 512, columns = 512;
  gonio::capture::outline_circle outline{256.0, 256.0, 256.0};
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< of the camera, as in gonio::capture::light_probe
  double photographer = 0.0;                           ///< radians around the camera's direction that are black
  int samples = 4;                                     ///< each pixel averages samples x samples rays

  /// A square image with the sphere in the middle, and a margin around it in radii of the sphere.
  [[nodiscard]] static probe_view square(std::size_t pixels, double margin = 0.0) {
    const double half = static_cast<double>(pixels) / 2.0;
    return {.rows = pixels, .columns = pixels, .outline = {half, half, half / (1.0 + margin)}};
  }
};

/// Returns the image of the sphere, black beside it. `radiance(direction)` is the light from a direction.
template <class Radiance>
[[nodiscard]] gonio::image photograph(const gonio::capture::mirror_sphere& sphere, const Radiance& radiance,
                                      const probe_view& view) {
  gonio::image image = gonio::uniform_image(view.rows, view.columns);
  const auto& [middle_column, middle_row, radius] = view.outline;
  const double nearest = std::cos(view.photographer);
  for (std::size_t row = 0; row < view.rows; ++row)
    for (std::size_t column = 0; column < view.columns; ++column) {
      gonio::rgb sum = gonio::rgb::Zero();
      for (int i = 0; i < view.samples; ++i)
        for (int j = 0; j < view.samples; ++j) {
          const double x = (static_cast<double>(column) + (j + 0.5) / view.samples - middle_column) / radius;
          const double y = (middle_row - static_cast<double>(row) - (i + 0.5) / view.samples) / radius;
          const auto light = sphere.light_at({x, y});
          if (!light || (view.photographer > 0.0 && light->z() > nearest)) continue;
          sum += radiance(gonio::direction(view.axes * *light));
        }
      gonio::set_pixel(image, row, column, sum / (view.samples * view.samples));
    }
  return image;
}

/// Returns the photograph as a probe whose camera is known.
template <class Radiance>
[[nodiscard]] gonio::capture::light_probe probe(const gonio::capture::mirror_sphere& sphere, const Radiance& radiance,
                                                const probe_view& view) {
  return {photograph(sphere, radiance, view), sphere, view.outline, view.axes, view.photographer};
}

}  // namespace lab
