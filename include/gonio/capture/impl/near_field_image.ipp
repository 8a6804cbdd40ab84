#pragma once
/// Bodies of capture/near_field_image.hpp.

#include <gonio/capture/near_field_image.hpp>
#include <gonio/capture/surface_light.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/pinhole_camera.hpp>
#include <gonio/table/image.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace gonio::capture {

GONIO_INLINE bool sample_disc::contains(const Eigen::Vector3d& point) const noexcept {
  return (point.head<2>() - centre).norm() <= radius;
}

GONIO_INLINE void require_usable(const near_field_setup& setup) {
  const auto refuse_unless = [](bool usable, const std::string& what) {
    if (!usable) gonio::refuse(what);
  };
  // Check that the camera and the light see the sample.
  const double height = setup.camera.position().z();
  refuse_unless(height > 0.0, "the camera is not above the sample's plane, its z is " + std::to_string(height));
  require_usable(setup.light);
  const auto* lamp = std::get_if<point_lamp>(&setup.light);
  const double light = lamp ? lamp->position.z() : std::get<directional_light>(setup.light).towards.z();
  refuse_unless(light > 0.0, "the light is at or below the sample's horizon, its z is " + std::to_string(light));
  // Check that the region and the window contain pixels.
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
        "the window must have pixels, all inside the image of " + std::to_string(whole.columns) + " x " +
            std::to_string(whole.rows));
  }
  // Check the mask, the saturation and the block size.
  refuse_unless(
      setup.mask.empty() || setup.mask.size() == setup.camera.intrinsics().rows * setup.camera.intrinsics().columns,
      "the mask has " + std::to_string(setup.mask.size()) + " pixels, expected as many as the image");
  if (setup.saturation) refuse_unless(*setup.saturation > 0.0, "the saturation must be positive");
  refuse_unless(setup.block > 0, "a block needs at least one pixel a side");
}

}  // namespace gonio::capture

namespace gonio::capture::detail {

GONIO_INLINE std::optional<seen_point> point_of_pixel(const near_field_setup& setup, std::size_t row,
                                                      std::size_t column) {
  if (!setup.mask.empty() && !setup.mask[row * setup.camera.intrinsics().columns + column]) return {};
  const ray line = setup.camera.ray_through(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
  const auto point = line.at_ground();
  if (!point || (setup.disc && !setup.disc->contains(*point))) return {};
  return seen_point{*point, -line.towards};
}

/// Returns true if a value is saturated. Throws gonio::error for other values that are not finite; `what` names the
/// image.
GONIO_INLINE bool is_saturated(const rgb& value, const near_field_setup& setup, const char* what, std::size_t row,
                               std::size_t column) {
  // Compare in float, like the image. Merged exposures may be infinite where all exposures were saturated.
  const bool saturated = setup.saturation && (value >= double{static_cast<float>(*setup.saturation)}).any();
  if (value.isNaN().any() || !(saturated || value.isFinite().all()))
    gonio::refuse({what, "pixel (row ", row, ", column ", column, ") is not finite, and it sees the sample"});
  return saturated;
}

GONIO_INLINE std::optional<near_field_reading> read_pixel(const image& picture, const near_field_setup& setup,
                                                          const std::optional<white_reference>& white, std::size_t row,
                                                          std::size_t column) {
  const auto point = point_of_pixel(setup, row, column);
  if (!point) return {};
  const lit_point lit = light_at(setup.light, point->position);
  const rgb radiance = pixel(picture, row, column);
  near_field_reading reading{lit.towards, point->view, radiance / (lit.irradiance * lit.towards.z()),
                             is_saturated(radiance, setup, "", row, column)};
  if (!white) return reading;
  const illumination here{lit.towards.z(), lit.distance};
  const auto of_white = white_illumination(*white, setup.light, row, column, here, 0.0);
  if (!of_white) return {};
  const rgb reference = pixel(white->photograph, row, column);
  reading.saturated = is_saturated(reference, setup, "the white image: ", row, column) || reading.saturated;
  if (!(reference > 0.0).all()) return {};
  if (reference.isFinite().all())
    reading.value = relative_to_white(radiance, here, reference, white->reflectance, *of_white);
  return reading;
}

GONIO_INLINE aperture block_aperture(const near_field_setup& setup, double row, double column) {
  const double half = 0.5 * static_cast<double>(setup.block);
  const auto half_vector_at = [&](double down, double right) -> std::optional<Eigen::Vector3d> {
    const ray line = setup.camera.ray_through(column + right * half, row + down * half);
    const auto point = line.at_ground();
    if (!point) return {};
    return (light_at(setup.light, *point).towards - line.towards).normalized();
  };
  const auto left = half_vector_at(0.0, -1.0), right = half_vector_at(0.0, 1.0), top = half_vector_at(-1.0, 0.0),
             bottom = half_vector_at(1.0, 0.0);
  const auto middle = setup.camera.ray_through(column, row).at_ground();
  if (!left || !right || !top || !bottom || !middle) return {};  // the block crosses the horizon
  return pixel_aperture(light_at(setup.light, *middle), *right - *left, *bottom - *top);
}

GONIO_INLINE void pixel_block::add(const near_field_reading& reading) {
  saturated = saturated || reading.saturated;
  values += reading.value;
  lights += reading.light;
  views += reading.view;
  ++pixels;
}

GONIO_INLINE void require_usable(const image& picture, const near_field_setup& setup,
                                 const std::optional<white_reference>& white) {
  capture::require_usable(setup);
  require_size(picture, setup.camera.intrinsics(), "the image");
  if (white) capture::require_usable(*white, setup.camera.intrinsics());
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE std::vector<Eigen::Index> pixels_of_region(const near_field_setup& setup) {
  require_usable(setup);
  const camera_intrinsics& whole = setup.camera.intrinsics();
  const pixel_window window = setup.window.value_or(pixel_window{0, 0, whole.columns, whole.rows});
  std::vector<Eigen::Index> seen;
  for (std::size_t row = window.row; row < window.row + window.rows; ++row)
    for (std::size_t column = window.column; column < window.column + window.columns; ++column)
      if (detail::point_of_pixel(setup, row, column)) seen.push_back(row * whole.columns + column);
  return seen;
}

GONIO_INLINE std::vector<rgb> region_reflectance(const image& picture, const near_field_setup& setup,
                                                 const std::optional<white_reference>& white) {
  detail::require_usable(picture, setup, white);
  const auto columns = static_cast<Eigen::Index>(setup.camera.intrinsics().columns);
  std::vector<rgb> values;
  for (const Eigen::Index number : pixels_of_region(setup)) {
    const auto reading = detail::read_pixel(picture, setup, white, number / columns, number % columns);
    values.push_back(reading ? reading->value : rgb::Zero());
  }
  return values;
}

GONIO_INLINE sample_set near_field_samples(const image& picture, const near_field_setup& setup,
                                           const std::optional<white_reference>& white) {
  detail::require_usable(picture, setup, white);
  const camera_intrinsics& whole = setup.camera.intrinsics();
  const pixel_window window = setup.window.value_or(pixel_window{0, 0, whole.columns, whole.rows});
  const std::size_t last_row = window.row + window.rows, last_column = window.column + window.columns;
  const auto end = [&](std::size_t first, std::size_t last) { return first + std::min(setup.block, last - first); };
  const double pixels_of_block = static_cast<double>(setup.block) * static_cast<double>(setup.block);

  sample_set samples;
  bool any_saturated = false;
  for (std::size_t row = window.row; row < last_row; row = end(row, last_row))
    for (std::size_t column = window.column; column < last_column; column = end(column, last_column)) {
      detail::pixel_block block;
      for (std::size_t r = row; r < end(row, last_row); ++r)
        for (std::size_t c = column; c < end(column, last_column); ++c)
          if (const auto reading = detail::read_pixel(picture, setup, white, r, c)) block.add(*reading);
      any_saturated = any_saturated || block.saturated;
      if (block.pixels == 0 || block.saturated) continue;
      const direction_pair seen{block.lights.normalized(), block.views.normalized()};
      // Skip a grazing view that rounding moves to the horizon.
      const cosine_pair cosine = cosines(to_half_difference(seen.wi, seen.wo));
      if (!(cosine.i > 0.0 && cosine.o > 0.0)) continue;
      const auto pixels = static_cast<double>(block.pixels);
      const double half = 0.5 * static_cast<double>(setup.block);
      samples.push_back(
          {seen, block.values / pixels, pixels / pixels_of_block,
           detail::block_aperture(setup, static_cast<double>(row) + half, static_cast<double>(column) + half)});
    }
  if (samples.empty())
    gonio::refuse(any_saturated ? "every pixel of the sample is saturated"
                                : "the image does not show the sample: no pixel's ray meets the region of interest");
  return samples;
}

}  // namespace gonio::capture
