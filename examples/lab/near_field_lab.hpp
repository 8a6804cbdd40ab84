#pragma once
/// A simulated laboratory for images from a short distance: a flat disc of a known material, a light and a camera, with
/// noise and misalignment.

#include "random_turn.hpp"
#include <gonio/capture/near_field_image.hpp>
#include <gonio/core/brdf.hpp>

#include <algorithm>
#include <cstdint>
#include <random>
#include <variant>

namespace lab {

/// The defects.
struct near_field_defects {
  /// Relative standard deviation of Gaussian noise, independent for each channel of each pixel.
  double noise = 0.0;
  /// Angle in radians by which light and camera are rotated about the centre of the sample, each about its own axis:
  /// the true direction of every ray differs from the assumed one by at most this angle.
  double misalignment = 0.0;
};

/// Returns a light rotated about the centre of the sample.
[[nodiscard]] inline gonio::capture::surface_light turned(gonio::capture::surface_light light,
                                                          const Eigen::Matrix3d& turn) {
  if (auto* distant = std::get_if<gonio::directional_light>(&light)) distant->towards = turn * distant->towards;
  if (auto* lamp = std::get_if<gonio::capture::point_lamp>(&light)) lamp->position = turn * lamp->position;
  return light;
}

/// Returns the true set-up if light and camera are rotated by an angle in radians, each about its own axis.
[[nodiscard]] inline gonio::capture::near_field_setup misaligned(gonio::capture::near_field_setup setup, double angle,
                                                                 std::mt19937_64& generator) {
  const Eigen::Matrix3d turn_light = random_turn(angle, generator), turn_camera = random_turn(angle, generator);
  setup.light = turned(setup.light, turn_light);
  const gonio::pinhole_camera& stated = setup.camera.pinhole();
  const gonio::pinhole_camera pinhole(stated.intrinsics(), stated.rotation() * turn_camera.transpose(),
                                      turn_camera * stated.position());
  setup.camera = gonio::lens_camera(pinhole, setup.camera.distortion());
  return setup;
}

/// Returns an image of a disc of the material: radiance under the set-up's light, black beside the disc and where the
/// light is below the horizon. `setup` is the assumed set-up; the seed determines the defects.
template <gonio::brdf Brdf>
[[nodiscard]] gonio::image photograph(const Brdf& material, const gonio::capture::sample_disc& disc,
                                      const gonio::capture::near_field_setup& setup,
                                      const near_field_defects& defects = {}, std::uint64_t seed = 0) {
  std::mt19937_64 generator(seed);
  const gonio::capture::near_field_setup true_setup = misaligned(setup, defects.misalignment, generator);
  const gonio::lens_camera& camera = true_setup.camera;
  const gonio::camera_intrinsics& size = camera.intrinsics();
  gonio::image image = gonio::uniform_image(size.rows, size.columns);
  std::normal_distribution<double> normal;
  for (std::size_t row = 0; row < size.rows; ++row)
    for (std::size_t column = 0; column < size.columns; ++column) {
      const gonio::ray line = camera.ray_through(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
      const auto point = line.at_ground();
      if (!point || !disc.contains(*point)) continue;
      const gonio::capture::lit_point lit = gonio::capture::light_at(true_setup.light, *point);
      gonio::rgb radiance = material(lit.towards, -line.towards) * lit.irradiance * std::max(lit.towards.z(), 0.0);
      if (defects.noise > 0.0)
        for (double& channel : radiance) channel *= 1.0 + defects.noise * normal(generator);
      gonio::set_pixel(image, row, column, radiance);
    }
  return image;
}

}  // namespace lab
