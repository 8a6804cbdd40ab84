#pragma once
/// The images that the tool draws of tables, and their options.

#include "tool/options/command.hpp"
#include <gonio/core/brdf.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/render/exposure.hpp>
#include <gonio/render/horizon_lookup.hpp>
#include <gonio/render/slice.hpp>
#include <gonio/render/sphere.hpp>

#include <optional>
#include <span>
#include <vector>

namespace cli {

struct image_options {
  int size = 256;
  std::optional<double> exposure;  ///< the mean luminance of a white Lambertian sphere; none: from the spheres
};

/// Adds `--size` and `--exposure`. Returns both, to add dependencies.
inline std::pair<option, option> add_image_options_to(command& to, image_options& options,
                                                      const char* default_exposure) {
  auto size = to.add_option("--size", options.size, "Rows and columns of each image")
                  .check(check::range(8, 4096))
                  .capture_default_str();
  auto exposure = to.add_option("--exposure", options.exposure,
                                "Mean luminance of a white Lambertian sphere in the image; 1 is white")
                      .check(check::positive_number())
                      .default_str(default_exposure);
  return {size, exposure};
}

/// Adds `--size` and `--exposure`, which need the option `image` (the file of the image).
inline void add_image_options(command& to, image_options& options, option image) {
  auto [size, exposure] = add_image_options_to(
      to, options, "white at the 99th percentile of the sphere, or of the measurement if there is one");
  size.needs(image);
  exposure.needs(image);
}

/// Returns an image of a sphere, by default under the two lights of Nielsen et al. 2015, Figure 2, where a white
/// Lambertian sphere has the mean luminance 1.
[[nodiscard]] inline gonio::image sphere_image(
    const gonio::brdf_table& table, const image_options& options, gonio::thread_count threads,
    const gonio::render::directional_lighting& lights = gonio::render::two_lights()) {
  return gonio::render::render_sphere(gonio::render::horizon_lookup(table), lights,
                                      {.size = options.size, .supersampling = 3}, threads);
}

/// Returns the image of a sphere whose grooves, if any, run about its vertical axis.
template <gonio::brdf Brdf>
[[nodiscard]] gonio::image turned_sphere_image(
    const Brdf& f, const image_options& options, gonio::thread_count threads,
    const gonio::render::directional_lighting& lights = gonio::render::two_lights()) {
  return gonio::render::render_sphere(f, lights, {.size = options.size, .supersampling = 3, .is_turned = true},
                                      threads);
}

/// Gives spheres the same exposure: the given one, or one for which the brightest of `by` is white at its 99th
/// percentile.
inline void expose_spheres(std::span<gonio::image> spheres, std::span<const gonio::image> by,
                           const image_options& options) {
  const double exposure = options.exposure ? *options.exposure : gonio::render::exposure_of_spheres(by);
  for (gonio::image& sphere : spheres) gonio::render::expose(sphere, exposure);
}

inline void expose_spheres(std::span<gonio::image> spheres, const image_options& options) {
  expose_spheres(spheres, spheres, options);
}

/// Returns a slice at phi_d = 90 degrees: theta_h to the right, theta_d upwards.
[[nodiscard]] inline gonio::image slice_image(const gonio::brdf_table& table, const image_options& options,
                                              gonio::thread_count threads) {
  return gonio::render::render_slice(table, {.rows = options.size, .columns = options.size}, threads);
}

}  // namespace cli
