#pragma once
/// A picture of a flat sample, taken from close by under a distant light, as measurements of its BRDF: every pixel has
/// its own viewing direction. Xu, Nielsen, Yu, Jensen and Ramamoorthi 2016, sections 5.2 and 7.
///
/// The sample lies in the plane z = 0. A pixel's value is the radiance L that it sees, so that f = L / (E cos theta_i),
/// where E is the irradiance of a surface that faces the light. If the values are in units of their own, so is E: of a
/// white reference of albedo rho, seen under the same light, E = pi L / (rho cos theta_i).

#include <gonio/core/pinhole_camera.hpp>
#include <gonio/table/image.hpp>
#include <gonio/table/picture_samples.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace gonio {

/// A light so far away that it comes from the same direction everywhere on the sample.
struct distant_light {
  direction towards;             ///< from the sample, of length 1
  rgb irradiance = rgb::Ones();  ///< of a surface that faces it
};

/// A disc in the plane of the sample, in the camera's unit of length.
struct sample_disc {
  double radius = 1.0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();

  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const noexcept {
    return (point.head<2>() - centre).norm() <= radius;
  }
};

/// A rectangle of a picture's pixels; the first row is at the top.
struct pixel_window {
  std::size_t column = 0, row = 0, columns = 0, rows = 0;
};

/// How a picture was taken, and what of it counts.
struct near_field_setup {
  pinhole_camera camera;
  distant_light light;
  /// The region of interest: the pixels that see the disc, those in the window, or if both are given, in both.
  std::optional<sample_disc> disc = {};
  std::optional<pixel_window> window = {};
  /// Whether each pixel counts, row by row, as clusters of materials say it; all do if it is empty.
  std::vector<bool> mask = {};
  /// Pixels with a channel of this value and more are skipped, and so are the blocks that they are in.
  std::optional<double> saturation = {};
  /// Pixels a side of the blocks that are averaged to one sample: less noise, and fewer samples.
  std::size_t block = 1;
};

/// Throws gonio::error unless camera and light are above the sample's plane, the light's direction has length 1, and
/// what can be measured in numbers is positive; a window must be inside the camera's picture.
inline void require_usable(const near_field_setup& setup) {
  const auto refuse_unless = [](bool usable, const std::string& what) {
    if (!usable) throw error(what);
  };
  const double height = setup.camera.position().z();
  refuse_unless(height > 0.0, "the camera is not above the sample's plane, its z is " + std::to_string(height));
  const direction& light = setup.light.towards;
  constexpr double tolerance = 1e-6;
  refuse_unless(std::abs(light.norm() - 1.0) < tolerance, "the light's direction must have length 1");
  refuse_unless(light.z() > 0.0,
                "the light is at or below the sample's horizon, its z is " + std::to_string(light.z()));
  const rgb& irradiance = setup.light.irradiance;
  refuse_unless(irradiance.isFinite().all() && (irradiance > 0.0).all(),
                "the light's irradiance must be finite and positive in each channel");
  if (setup.disc)
    refuse_unless(std::isfinite(setup.disc->radius) && setup.disc->radius > 0.0 && setup.disc->centre.allFinite(),
                  "the region of interest needs a positive radius and a finite centre");
  if (const auto& window = setup.window) {
    const auto inside = [](std::size_t first, std::size_t count, std::size_t all) {
      return first < all && count > 0 && count <= all - first;
    };
    const camera_intrinsics& whole = setup.camera.intrinsics();
    refuse_unless(
        inside(window->column, window->columns, whole.columns) && inside(window->row, window->rows, whole.rows),
        "the window must have pixels, all of them in the picture of " + std::to_string(whole.columns) + " x " +
            std::to_string(whole.rows));
  }
  refuse_unless(
      setup.mask.empty() || setup.mask.size() == setup.camera.intrinsics().rows * setup.camera.intrinsics().columns,
      "the mask has " + std::to_string(setup.mask.size()) + " pixels, which are not those of the picture");
  if (setup.saturation) refuse_unless(*setup.saturation > 0.0, "the saturation must be positive");
  refuse_unless(setup.block > 0, "a block needs at least one pixel a side");
}

namespace detail {

/// What a pixel sees of the region of interest, the window apart: the direction towards the camera, if anything.
[[nodiscard]] inline std::optional<direction> view_of_pixel(const near_field_setup& setup, std::size_t row,
                                                            std::size_t column) {
  if (!setup.mask.empty() && !setup.mask[row * setup.camera.intrinsics().columns + column]) return {};
  const ray line = setup.camera.ray_through(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
  const auto point = line.at_ground();
  if (!point || (setup.disc && !setup.disc->contains(*point))) return {};
  return -line.towards;
}

/// What the pixels of a block that see the region add up to.
struct pixel_block {
  rgb radiance = rgb::Zero();
  direction views = direction::Zero();
  std::size_t pixels = 0;
  bool saturated = false;
};

inline void add_pixel(const image& picture, const near_field_setup& setup, std::size_t row, std::size_t column,
                      pixel_block& block) {
  const std::optional<direction> view = view_of_pixel(setup, row, column);
  if (!view) return;
  const rgb value = pixel(picture, row, column);
  // In float, as the picture is. Several exposures in one may hold infinity where all of them were saturated.
  const bool saturated = setup.saturation && (value >= double{static_cast<float>(*setup.saturation)}).any();
  if (value.isNaN().any() || !(saturated || value.isFinite().all()))
    throw error("pixel (row " + std::to_string(row) + ", column " + std::to_string(column) +
                ") is not finite, and it sees the sample");
  block.saturated = block.saturated || saturated;
  block.radiance += value;
  block.views += *view;
  ++block.pixels;
}

/// The size of a picture must be its camera's.
inline void require_size(const image& picture, const camera_intrinsics& intrinsics) {
  const auto size = [](std::size_t columns, std::size_t rows) {
    return std::to_string(columns) + " x " + std::to_string(rows);
  };
  if (picture.shape(2) != 3) throw error("a picture of " + std::to_string(picture.shape(2)) + " channels, expected 3");
  if (picture.shape(0) != intrinsics.rows || picture.shape(1) != intrinsics.columns)
    throw error("the picture has " + size(picture.shape(1), picture.shape(0)) + " pixels, its camera " +
                size(intrinsics.columns, intrinsics.rows));
}

}  // namespace detail

/// The numbers, row by row, of the pixels that see the region of interest. Throws gonio::error as `require_usable`
/// does.
[[nodiscard]] inline std::vector<std::size_t> pixels_of_region(const near_field_setup& setup) {
  require_usable(setup);
  const camera_intrinsics& whole = setup.camera.intrinsics();
  const pixel_window window = setup.window.value_or(pixel_window{0, 0, whole.columns, whole.rows});
  std::vector<std::size_t> seen;
  for (std::size_t row = window.row; row < window.row + window.rows; ++row)
    for (std::size_t column = window.column; column < window.column + window.columns; ++column)
      if (detail::view_of_pixel(setup, row, column)) seen.push_back(row * whole.columns + column);
  return seen;
}

/// One sample for each block of pixels that see the region of interest, row by row from the picture's (or the
/// window's) top left corner. Value and viewing direction are the means of those pixels, the weight is their share of
/// the block. Throws gonio::error as `require_usable` does, if the picture's size is not the camera's, naming a pixel
/// of the region that is not finite, or if nothing of the sample is seen.
/// ```cpp
/// const gonio::distant_light lamp{gonio::spherical_direction(theta_i, 0.0)};
/// const auto samples =
///     gonio::near_field_pairs(picture, {.camera = camera, .light = lamp, .disc = gonio::sample_disc{0.2}});
/// ```
[[nodiscard]] inline picture_samples near_field_pairs(const image& picture, const near_field_setup& setup) {
  require_usable(setup);
  const camera_intrinsics& whole = setup.camera.intrinsics();
  detail::require_size(picture, whole);
  const pixel_window window = setup.window.value_or(pixel_window{0, 0, whole.columns, whole.rows});
  const std::size_t last_row = window.row + window.rows, last_column = window.column + window.columns;
  const auto end = [&](std::size_t first, std::size_t last) { return first + std::min(setup.block, last - first); };
  const rgb reflected = setup.light.irradiance * setup.light.towards.z();
  const double pixels_of_block = static_cast<double>(setup.block) * static_cast<double>(setup.block);

  picture_samples samples;
  bool any_saturated = false;
  for (std::size_t row = window.row; row < last_row; row = end(row, last_row))
    for (std::size_t column = window.column; column < last_column; column = end(column, last_column)) {
      detail::pixel_block block;
      for (std::size_t r = row; r < end(row, last_row); ++r)
        for (std::size_t c = column; c < end(column, last_column); ++c) detail::add_pixel(picture, setup, r, c, block);
      any_saturated = any_saturated || block.saturated;
      if (block.pixels == 0 || block.saturated) continue;
      const direction_pair seen{setup.light.towards, block.views.normalized()};
      // A view that grazes the sample may round to one at the horizon.
      const cosine_pair cosine = cosines(to_half_difference(seen.wi, seen.wo));
      if (!(cosine.i > 0.0 && cosine.o > 0.0)) continue;
      const auto pixels = static_cast<double>(block.pixels);
      samples.push_back({seen, block.radiance / (pixels * reflected), pixels / pixels_of_block});
    }
  if (samples.empty())
    throw error(any_saturated ? "all that the picture sees of the sample is saturated"
                              : "the picture sees nothing of the sample: no pixel's ray meets the region of interest");
  return samples;
}

/// The same as samples for any estimator, which light and viewer may change places in.
[[nodiscard]] inline sample_set near_field_samples(const image& picture, const near_field_setup& setup) {
  return as_sample_set(near_field_pairs(picture, setup));
}

}  // namespace gonio
