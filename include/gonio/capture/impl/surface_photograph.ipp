#pragma once
/// Bodies of capture/surface_photograph.hpp.

#include <gonio/capture/surface_light.hpp>
#include <gonio/capture/surface_photograph.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/table/image.hpp>
#include <gonio/table/sample_set.hpp>
#include <gonio/table/surface_image.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace gonio::capture::detail {

/// Throws gonio::error if the light is a lamp at a finite distance and the surface has no positions.
GONIO_INLINE void require_positions(const surface_image& surface, const surface_light& light) {
  if (std::holds_alternative<directional_light>(light)) return;
  for (Eigen::Index pixel = 0; pixel < surface.normals.cols(); ++pixel)
    if (surface.sees(pixel) && !surface.positions.col(pixel).isZero(0.0)) return;
  gonio::refuse("a lamp at a finite distance needs the positions of the surface, not only its normals");
}

/// Returns true if the light reaches any visible point. A lamp inside a closed surface is behind all of its points.
GONIO_INLINE bool lights_any(const surface_image& surface, const surface_light& light) {
  for (Eigen::Index pixel = 0; pixel < surface.normals.cols(); ++pixel) {
    if (!surface.sees(pixel)) continue;
    const Eigen::Vector3d normal = surface.normals.col(pixel);
    if (normal.dot(light_at(light, surface.positions.col(pixel)).towards) > 0.0) return true;
  }
  return false;
}

/// Returns true if a pixel and all its neighbours see the surface.
GONIO_INLINE bool is_interior(const surface_image& surface, std::size_t row, std::size_t column) {
  if (row == 0 || column == 0 || row + 1 >= surface.rows || column + 1 >= surface.columns) return false;
  for (std::size_t r = row - 1; r <= row + 1; ++r)
    for (std::size_t c = column - 1; c <= column + 1; ++c)
      if (!surface.sees(surface.pixel(r, c))) return false;
  return true;
}

/// Returns light and viewer in a local frame with the normal as its z axis. The choice of its x axis is arbitrary for
/// isotropic materials.
GONIO_INLINE direction_pair around_normal(const Eigen::Vector3d& normal, const direction& light,
                                          const direction& viewer) {
  const Eigen::Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
  const auto local = [&](const direction& w) { return direction(x.dot(w), y.dot(w), normal.dot(w)).normalized(); };
  return {local(light), local(viewer)};
}

/// The reading of one pixel.
struct pixel_reading {
  direction_pair pair;
  rgb value;
  aperture cones;
};

/// Reads pixels of a photograph, one at a time.
class pixel_reader {
 public:
  pixel_reader(const image& photograph, const surface_image& surface, const lens_camera& camera,
               const surface_light& light, const std::optional<white_reference>& white,
               const photograph_options& options)
      : photograph_(photograph), surface_(surface), camera_(camera), light_(light), white_(white), options_(options) {}

  /// Returns the reading of a pixel, or nothing if the pixel is not used.
  [[nodiscard]] std::optional<pixel_reading> read(std::size_t row, std::size_t column) {
    if (!is_interior(surface_, row, column)) return {};
    const Eigen::Index number = surface_.pixel(row, column);
    const Eigen::Vector3d normal = surface_.normals.col(number);
    const lit_point lit = light_at(light_, surface_.positions.col(number));
    const ray line = camera_.ray_through(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    const direction_pair pair = around_normal(normal, lit.towards, -line.towards);
    const std::optional<rgb> radiance = value_of(photograph_, "the photograph", row, column);
    if (!(pair.wi.z() >= options_.smallest_cosine && pair.wo.z() >= options_.smallest_cosine)) return {};
    if (!radiance) return {};
    std::optional<rgb> value = *radiance / (lit.irradiance * pair.wi.z());
    if (white_) value = relative_value(*radiance, pair.wi.z(), lit.distance, row, column);
    if (!value) return {};
    const Eigen::Vector3d across = half_vector_off_normal(row, column + 1) - half_vector_off_normal(row, column - 1),
                          down = half_vector_off_normal(row + 1, column) - half_vector_off_normal(row - 1, column);
    return pixel_reading{pair, *value, pixel_aperture(lit, 0.5 * across, 0.5 * down)};
  }

  [[nodiscard]] Eigen::Index saturated() const noexcept { return saturated_; }

 private:
  [[nodiscard]] Eigen::Vector3d half_vector_off_normal(std::size_t row, std::size_t column) const {
    const Eigen::Index number = surface_.pixel(row, column);
    const lit_point lit = light_at(light_, surface_.positions.col(number));
    const ray line = camera_.ray_through(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    return (lit.towards - line.towards).normalized() - surface_.normals.col(number);
  }

  /// Returns the value of a pixel, or nothing if it is saturated. Throws gonio::error for NaN.
  [[nodiscard]] std::optional<rgb> value_of(const image& picture, const char* what, std::size_t row,
                                            std::size_t column) {
    const rgb value = pixel(picture, row, column);
    if (value.isNaN().any())
      gonio::refuse({what, ": pixel (row ", row, ", column ", column, ") is not a number, and it sees the surface"});
    // Compare in float, like the image.
    const bool saturated = options_.saturation && (value >= double{static_cast<float>(*options_.saturation)}).any();
    if (!saturated && value.isFinite().all()) return value;
    ++saturated_;
    return {};
  }

  /// Returns f by Eq. 20 to 22 if the reference is lit and visible.
  [[nodiscard]] std::optional<rgb> relative_value(const rgb& radiance, double cosine, double distance, std::size_t row,
                                                  std::size_t column) {
    const illumination here{cosine, distance};
    const auto of_white = white_illumination(*white_, light_, row, column, here, options_.smallest_cosine);
    if (!of_white) return {};
    const std::optional<rgb> reference = value_of(white_->photograph, "the white image", row, column);
    if (!reference || !(*reference > 0.0).all()) return {};
    return relative_to_white(radiance, here, *reference, white_->reflectance, *of_white);
  }

  const image& photograph_;
  const surface_image& surface_;
  const lens_camera& camera_;
  const surface_light& light_;
  const std::optional<white_reference>& white_;
  const photograph_options& options_;
  Eigen::Index saturated_ = 0;
};

/// Sums over the pixels whose angles are in one cell.
struct cell_mean {
  Eigen::Index pixels = 0;
  direction_pair first;
  half_difference angles;  ///< sums
  rgb sum = rgb::Zero(), squares = rgb::Zero();
  aperture cones;  ///< sums

  void add(const pixel_reading& reading, const half_difference& at) {
    if (pixels++ == 0) first = reading.pair;
    angles = {angles.theta_h + at.theta_h, angles.theta_d + at.theta_d, angles.phi_d + at.phi_d};
    sum += reading.value;
    squares += reading.value.square();
    cones = {cones.source + reading.cones.source, cones.receiver + reading.cones.receiver};
  }

  [[nodiscard]] sample_directions directions() const {
    if (pixels == 1) return first;
    const auto n = static_cast<double>(pixels);
    return half_difference{angles.theta_h / n, angles.theta_d / n, angles.phi_d / n};
  }
  [[nodiscard]] aperture mean_cones() const {
    const auto n = static_cast<double>(pixels);
    return {cones.source / n, cones.receiver / n};
  }
  [[nodiscard]] rgb mean() const { return sum / static_cast<double>(pixels); }
  /// Returns the relative standard deviation of a single pixel in this cell.
  [[nodiscard]] rgb scatter() const {
    const auto n = static_cast<double>(pixels);
    return ((squares - sum.square() / n).max(0.0) / (n - 1.0)).sqrt() / mean().abs().max(1e-300);
  }
};

using cell_means = std::map<Eigen::Index, cell_mean>;

/// Returns the median scatter of the cells with at least four pixels; 0 if there is no such cell.
GONIO_INLINE rgb median_scatter(const cell_means& cells) {
  constexpr Eigen::Index enough = 4;
  std::array<std::vector<double>, 3> all;
  for (const auto& [number, cell] : cells) {
    if (cell.pixels < enough) continue;
    const rgb scatter = cell.scatter();
    for (Eigen::Index c = 0; c < 3; ++c) all[static_cast<std::size_t>(c)].push_back(scatter[c]);
  }
  rgb found = rgb::Zero();
  for (Eigen::Index c = 0; c < 3; ++c)
    if (auto& of_channel = all[static_cast<std::size_t>(c)]; !of_channel.empty())
      found[c] = median(std::move(of_channel));
  return found;
}

GONIO_INLINE sample_set samples_of_cells(const cell_means& cells, const rgb& deviation) {
  sample_set samples;
  for (const auto& [number, cell] : cells) {
    const sample_directions at = cell.directions();
    const cosine_pair cosine = cosines(at.angles());
    if (!(cosine.i > 0.0 && cosine.o > 0.0)) continue;
    rgb weight;
    for (Eigen::Index c = 0; c < 3; ++c)
      weight[c] = weight_of(deviation[c] / std::sqrt(static_cast<double>(cell.pixels)));
    samples.push_back({at, cell.mean(), weight, cell.mean_cones()});
  }
  return samples;
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE photograph_samples samples_of(const image& photograph, const surface_image& surface,
                                           const lens_camera& camera, const surface_light& light,
                                           const std::optional<white_reference>& white,
                                           const photograph_options& options) {
  // Check the sizes, and that the light reaches the surface.
  const camera_intrinsics& size = camera.intrinsics();
  require_usable(light);
  detail::require_size(photograph, size, "the photograph");
  detail::require_size(surface.columns, surface.rows, size, "the surface");
  detail::require_positions(surface, light);
  if (white) require_usable(*white, size);
  if (!detail::lights_any(surface, light)) refuse("the light is behind or inside the visible surface");

  // Read all pixels into their cells.
  detail::pixel_reader reader(photograph, surface, camera, light, white, options);
  detail::cell_means cells;
  photograph_samples found;
  for (std::size_t row = 0; row < size.rows; ++row)
    for (std::size_t column = 0; column < size.columns; ++column) {
      const auto reading = reader.read(row, column);
      if (!reading) continue;
      const half_difference angles = to_half_difference(reading->pair.wi, reading->pair.wo);
      cells[options.cells.linear(options.cells.nearest(angles))].add(*reading, angles);
      ++found.pixels;
    }

  // Average each cell.
  found.saturated = reader.saturated();
  found.pixel_deviation = detail::median_scatter(cells);
  found.samples = detail::samples_of_cells(cells, found.pixel_deviation);
  if (found.samples.empty())
    refuse(found.saturated > 0 ? "every pixel of the surface is saturated"
                               : "the photograph shows no lit part of the surface");
  return found;
}

}  // namespace gonio::capture
