#pragma once
/// A simulated laboratory for images from close by: a flat disc of a known material, a distant light and a pinhole
/// camera, with noise, and with light and camera not quite where they are said to be.

#include "random_turn.hpp"
#include <gonio/capture/near_field_image.hpp>
#include <gonio/core/brdf.hpp>

#include <algorithm>
#include <cstdint>
#include <random>

namespace lab {

/// What goes wrong.
struct near_field_defects {
  /// Standard deviation of Gaussian noise relative to the value, independent in each channel of each pixel.
  double noise = 0.0;
  /// Angle in radians by which the light, and the camera, are turned about the middle of the sample, each about an
  /// axis of its own: the true direction of every ray differs from the assumed one by at most this angle.
  double misalignment = 0.0;
};

/// An image of a disc of the material: radiance under the set-up's light, black beside the disc and where the light is
/// below the horizon. The defects come from the seed alone; the set-up is what the experimenter believes.
template <gonio::brdf Brdf>
[[nodiscard]] gonio::image photograph(const Brdf& material, const gonio::capture::sample_disc& disc,
                                      const gonio::capture::near_field_setup& setup,
                                      const near_field_defects& defects = {}, std::uint64_t seed = 0) {
  std::mt19937_64 generator(seed);
  const Eigen::Matrix3d turn_light = random_turn(defects.misalignment, generator);
  const Eigen::Matrix3d turn_camera = random_turn(defects.misalignment, generator);
  const gonio::direction light = turn_light * setup.light.towards;
  const gonio::pinhole_camera camera(setup.camera.intrinsics(), setup.camera.rotation() * turn_camera.transpose(),
                                     turn_camera * setup.camera.position());

  const gonio::camera_intrinsics& size = camera.intrinsics();
  gonio::image image = gonio::uniform_image(size.rows, size.columns);
  std::normal_distribution<double> normal;
  for (std::size_t row = 0; row < size.rows; ++row)
    for (std::size_t column = 0; column < size.columns; ++column) {
      const gonio::ray line = camera.ray_through(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
      const auto point = line.at_ground();
      if (!point || !disc.contains(*point)) continue;
      gonio::rgb radiance = material(light, -line.towards) * setup.light.irradiance * std::max(light.z(), 0.0);
      if (defects.noise > 0.0)
        for (double& channel : radiance) channel *= 1.0 + defects.noise * normal(generator);
      gonio::set_pixel(image, row, column, radiance);
    }
  return image;
}

}  // namespace lab
