#pragma once
/// A simulated light probe: the image of a mirror sphere in an environment.

#include <gonio/capture/mirror_sphere.hpp>

namespace lab {

/// Returns a square image filled by the sphere, black beside it. `radiance(direction)` is the light from a direction.
/// Each pixel averages `samples` x `samples` rays; rays beside the sphere are black.
template <class Radiance>
[[nodiscard]] gonio::image photograph(const gonio::capture::mirror_sphere& sphere, const Radiance& radiance,
                                      std::size_t pixels, int samples = 4) {
  gonio::image image = gonio::uniform_image(pixels, pixels);
  const double scale = 2.0 / static_cast<double>(pixels);
  for (std::size_t row = 0; row < pixels; ++row)
    for (std::size_t column = 0; column < pixels; ++column) {
      gonio::rgb sum = gonio::rgb::Zero();
      for (int i = 0; i < samples; ++i)
        for (int j = 0; j < samples; ++j) {
          const double x = scale * (static_cast<double>(column) + (j + 0.5) / samples) - 1.0;
          const double y = 1.0 - scale * (static_cast<double>(row) + (i + 0.5) / samples);
          if (const auto light = sphere.light_at({x, y})) sum += radiance(*light);
        }
      gonio::set_pixel(image, row, column, sum / (samples * samples));
    }
  return image;
}

}  // namespace lab
