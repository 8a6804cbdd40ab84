#pragma once
/// Bodies of capture/light_probe.hpp.

#include <gonio/capture/light_probe.hpp>
#include <gonio/capture/mirror_sphere.hpp>
#include <gonio/capture/outline_circle.hpp>
#include <gonio/capture/sphere_outline.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/pinhole_camera.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::capture {

GONIO_INLINE void light_probe::require_usable() const {
  const auto& [column, row, radius] = outline;
  const auto rows = static_cast<double>(photograph.shape(0)), columns = static_cast<double>(photograph.shape(1));
  if (photograph.shape(2) != 3 || !(radius >= 4.0))
    refuse("an image of a mirror sphere must show it 8 pixels wide or more");
  constexpr double slack = 0.5;
  if (!(column - radius >= -slack && row - radius >= -slack && column + radius <= columns + slack &&
        row + radius <= rows + slack))
    refuse({"an image of a mirror sphere must show all of it: expected the outline at column ", column, ", row ", row,
            " with a radius of ", radius, " pixels within ", photograph.shape(0), " x ", photograph.shape(1),
            " pixels"});
  for (std::size_t r = 0; r < photograph.shape(0); ++r)
    for (std::size_t c = 0; c < photograph.shape(1); ++c) {
      const double down = static_cast<double>(r) + 0.5 - row, across = static_cast<double>(c) + 0.5 - column;
      if (down * down + across * across <= radius * radius && !pixel(photograph, r, c).isFinite().all())
        refuse({"an image of a mirror sphere must be finite: pixel (row ", r, ", column ", c, ") is not"});
    }
  if (!axes.allFinite() || !(axes.transpose() * axes).isIdentity(1e-3) || !(axes.determinant() > 0.0))
    refuse("a camera's axes must be a rotation");
  if (!(photographer >= 0.0 && photographer <= std::numbers::pi / 2.0))
    refuse("a photographer hides an angle from 0 to 90 degrees, not " + std::to_string(degrees(photographer)));
}

GONIO_INLINE outline_circle filled_outline(const image& photograph) {
  if (photograph.shape(1) != photograph.shape(0))
    refuse("an image that a mirror sphere fills must be square, not " + std::to_string(photograph.shape(0)) + " x " +
           std::to_string(photograph.shape(1)));
  const double half = static_cast<double>(photograph.shape(0)) / 2.0;
  return {half, half, half};
}

}  // namespace gonio::capture

namespace gonio::capture::detail {

/// Returns the photograph with highlights compressed, L / (L + m), where m is the median brightness in the middle of
/// the image. A lamp's mirror image is a thousand times as bright as most of the sphere; the rim is darker than most.
GONIO_INLINE image compressed(const image& photograph) {
  const std::size_t rows = photograph.shape(0), columns = photograph.shape(1);
  std::vector<double> middle;
  for (std::size_t row = rows / 4; row < rows - rows / 4; ++row)
    for (std::size_t column = columns / 4; column < columns - columns / 4; ++column)
      if (const double value = pixel(photograph, row, column).sum(); value > 0.0) middle.push_back(value);
  if (middle.empty()) return photograph;
  const auto level = static_cast<float>(std::min(median(std::move(middle)), 1e30));
  image result = photograph;
  std::transform(result.begin(), result.end(), result.begin(), [=](float value) {
    return std::isnan(value) ? value : std::max(value, 0.0f) / (std::min(std::max(value, 0.0f), 1e30f) + level);
  });
  return result;
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE outline_circle find_outline(const image& photograph) {
  // Assume a camera whose image spans a hundredth of a radian: from far away, the outline is a circle.
  constexpr double field_of_view = 0.01;
  const auto rows = static_cast<double>(photograph.shape(0)), columns = static_cast<double>(photograph.shape(1));
  const double focal_length = std::max(rows, columns) / field_of_view;
  const lens_camera camera(pinhole_camera({.rows = photograph.shape(0),
                                           .columns = photograph.shape(1),
                                           .focal_length_x = focal_length,
                                           .focal_length_y = focal_length,
                                           .principal_x = columns / 2.0,
                                           .principal_y = rows / 2.0},
                                          Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()));
  const placed_sphere found = find_sphere(detail::compressed(photograph), camera, 1.0).sphere;
  const Eigen::Vector3d& centre = found.centre;
  const double distance = centre.norm();
  return {columns / 2.0 + focal_length * centre.x() / centre.z(), rows / 2.0 + focal_length * centre.y() / centre.z(),
          focal_length * std::tan(std::asin(1.0 / distance))};
}

GONIO_INLINE Eigen::Matrix3d camera_axes(double azimuth, double elevation, double roll) {
  for (const double angle : {azimuth, elevation, roll})
    if (!std::isfinite(angle)) refuse("a camera's azimuth, elevation and roll must be finite");
  const direction towards(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                          std::cos(azimuth) * std::cos(elevation));
  const direction level(std::cos(azimuth), 0.0, -std::sin(azimuth)), upright = towards.cross(level);
  Eigen::Matrix3d axes;
  axes.col(0) = std::cos(roll) * level + std::sin(roll) * upright;
  axes.col(1) = std::cos(roll) * upright - std::sin(roll) * level;
  axes.col(2) = towards;
  return axes;
}

GONIO_INLINE int unwrap_options::samples_for(std::size_t pixels) const noexcept {
  if (samples > 0) return samples;
  const double needed = std::numbers::pi * static_cast<double>(pixels) / (4.0 * static_cast<double>(rows));
  return std::clamp(static_cast<int>(std::ceil(needed)), 2, 32);
}

}  // namespace gonio::capture

namespace gonio::capture::detail {

GONIO_INLINE void require_unwrappable(const unwrap_options& options) {
  if (options.rows == 0 || options.samples < 0)
    refuse("an unwrapped map needs at least one row, and its number of samples must not be negative");
  if (!(options.reflectance > 0.0 && options.reflectance <= 1.0))
    refuse("a mirror's reflectance must be above 0 and up to 1, not " + std::to_string(options.reflectance));
}

GONIO_INLINE rgb read_probe(const light_probe& probe, const Eigen::Vector2d& position) noexcept {
  const auto& [middle_column, middle_row, radius] = probe.outline;
  const double whole = radius - std::sqrt(0.5), distance = position.norm();
  for (double rim = 1.0 - 0.75 / radius;; rim -= 0.25 / radius) {
    const Eigen::Vector2d inside = distance > rim ? Eigen::Vector2d(position * (rim / distance)) : position;
    const double column = middle_column + radius * inside.x() - 0.5, row = middle_row - radius * inside.y() - 0.5;
    rgb sum = rgb::Zero();
    double weights = 0.0;
    for (const double r : {std::floor(row), std::floor(row) + 1.0})
      for (const double c : {std::floor(column), std::floor(column) + 1.0}) {
        const double weight = (1.0 - std::abs(row - r)) * (1.0 - std::abs(column - c));
        if (!(weight > 0.0) || std::hypot(c + 0.5 - middle_column, r + 0.5 - middle_row) > whole) continue;
        sum += weight * pixel(probe.photograph, static_cast<std::size_t>(r), static_cast<std::size_t>(c));
        weights += weight;
      }
    if (weights > 0.0) return sum / weights;
  }
}

GONIO_INLINE rgb light_from(const light_probe& probe, const direction& towards) noexcept {
  const direction seen = probe.axes.transpose() * towards;
  if (const auto position = probe.sphere.position_of(seen)) return read_probe(probe, *position);
  const double across = std::hypot(seen.x(), seen.y());
  return read_probe(probe,
                    across > 0.0 ? Eigen::Vector2d(seen.x() / across, seen.y() / across) : Eigen::Vector2d(1.0, 0.0));
}

GONIO_INLINE double probe_weight(const light_probe& probe, const direction& towards) noexcept {
  const direction seen = probe.axes.transpose() * towards;
  const double polar = std::atan2(std::hypot(seen.x(), seen.y()), seen.z());
  double shown = 1.0;
  if (probe.photographer > 0.0) {
    const double beside = std::clamp((polar / probe.photographer - 1.0) / 0.5, 0.0, 1.0);
    shown = beside * beside * (3.0 - 2.0 * beside);
  }
  return shown * std::pow(probe.outline.radius * probe.sphere.resolution(polar), 4);
}

/// Returns the mean light over the probes from a world direction.
GONIO_INLINE rgb merged_light(std::span<const light_probe> probes, const direction& towards) {
  if (probes.size() == 1) return light_from(probes.front(), towards);
  rgb sum = rgb::Zero(), hidden = rgb::Zero();
  double weights = 0.0;
  for (const light_probe& probe : probes) {
    const double weight = probe_weight(probe, towards);
    if (!(weight > 0.0)) continue;
    sum += weight * light_from(probe, towards);
    weights += weight;
  }
  if (weights > 0.0) return sum / weights;
  for (const light_probe& probe : probes) hidden += light_from(probe, towards);
  return hidden / static_cast<double>(probes.size());
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE image unwrap(std::span<const light_probe> probes, const unwrap_options& options, thread_count threads) {
  if (probes.empty()) refuse("an unwrapped map needs at least one photograph of a mirror sphere");
  detail::require_unwrappable(options);
  double largest_radius = 0.0;
  for (const light_probe& probe : probes) {
    probe.require_usable();
    largest_radius = std::max(largest_radius, probe.outline.radius);
  }

  const int samples = options.samples_for(static_cast<std::size_t>(std::lround(2.0 * largest_radius)));
  image map({options.rows, 2 * options.rows, std::size_t{3}});
  const double step = std::numbers::pi / static_cast<double>(options.rows);
  for_each_block(
      options.rows, 4,
      [&](block rows) {
        for (Eigen::Index row = rows.begin; row < rows.end; ++row)
          for (std::size_t column = 0; column < 2 * options.rows; ++column) {
            rgb sum = rgb::Zero();
            for (int i = 0; i < samples; ++i)
              for (int j = 0; j < samples; ++j) {
                const double down = (i + 0.5) / samples, across = (j + 0.5) / samples;
                const double polar = step * (static_cast<double>(row) + down);
                const double longitude = step * (static_cast<double>(column) + across) - std::numbers::pi;
                sum += detail::merged_light(probes, {std::sin(polar) * std::sin(longitude), std::cos(polar),
                                                     -std::sin(polar) * std::cos(longitude)});
              }
            set_pixel(map, row, column, (sum / (samples * samples * options.reflectance)).max(0.0));
          }
      },
      threads);
  return map;
}

GONIO_INLINE image unwrap(const image& probe, const mirror_sphere& sphere, const unwrap_options& options,
                          thread_count threads) {
  const light_probe filling{probe, sphere, filled_outline(probe)};
  return unwrap({&filling, 1}, options, threads);
}

}  // namespace gonio::capture
