#pragma once
/// Bodies of capture/mirror_sphere.hpp.

#include <gonio/capture/mirror_sphere.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/table/image.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

namespace gonio::capture {

GONIO_INLINE mirror_sphere::mirror_sphere(double distance) : distance_(distance) {
  if (!(distance > 1.0))
    refuse("the camera must stand outside the mirror sphere, more than one radius from its centre, not " +
           std::to_string(distance));
}

GONIO_INLINE mirror_sphere mirror_sphere::spanning(double angle) {
  if (!(angle > 0.0 && angle < std::numbers::pi))
    refuse("a mirror sphere spans an angle between 0 and 180 degrees, not " + std::to_string(degrees(angle)));
  return mirror_sphere(1.0 / std::sin(angle / 2.0));
}

GONIO_INLINE std::optional<Eigen::Vector2d> mirror_sphere::place_of(const direction& light) const noexcept {
  const double across = std::hypot(light.x(), light.y()), polar = std::atan2(across, light.z());
  if (polar > largest_polar_angle()) return {};
  const double radius = radius_of(normal_angle(polar));
  if (!(across > 0.0)) return Eigen::Vector2d(polar > 1.0 ? 1.0 : 0.0, 0.0);
  return Eigen::Vector2d(light.x(), light.y()) * (radius / across);
}

GONIO_INLINE std::optional<direction> mirror_sphere::light_at(const Eigen::Vector2d& place) const noexcept {
  const double radius = place.norm();
  if (!(radius <= 1.0)) return {};
  const double angle = angle_of(radius), polar = 2.0 * angle + leaning(angle);
  const Eigen::Vector2d across =
      radius > 0.0 ? Eigen::Vector2d(place * (std::sin(polar) / radius)) : Eigen::Vector2d::Zero();
  return direction(across.x(), across.y(), std::cos(polar));
}

GONIO_INLINE double mirror_sphere::normal_angle(double polar) const noexcept {
  double angle = polar / 2.0;
  if (is_far()) return angle;
  const double rim = std::acos(1.0 / distance_);
  for (int step = 0; step < 50; ++step) {
    const double cosine = std::cos(angle);
    const double slope = 2.0 + (distance_ * cosine - 1.0) / (distance_ * distance_ - 2.0 * distance_ * cosine + 1.0);
    const double next = std::clamp(angle - (2.0 * angle + leaning(angle) - polar) / slope, 0.0, rim);
    if (std::abs(next - angle) < 1e-14) return next;
    angle = next;
  }
  return angle;
}

GONIO_INLINE double mirror_sphere::angle_of(double radius) const noexcept {
  if (is_far()) return std::asin(radius);
  const double view = std::atan(radius / std::sqrt(distance_ * distance_ - 1.0));
  return std::asin(std::min(1.0, distance_ * std::sin(view))) - view;
}

GONIO_INLINE int unwrap_options::samples_for(std::size_t pixels) const noexcept {
  if (samples > 0) return samples;
  const double needed = std::numbers::pi * static_cast<double>(pixels) / (4.0 * static_cast<double>(rows));
  return std::clamp(static_cast<int>(std::ceil(needed)), 2, 32);
}

}  // namespace gonio::capture

namespace gonio::capture::detail {

GONIO_INLINE void require_unwrappable(const image& probe, const unwrap_options& options) {
  const std::size_t pixels = probe.shape(0);
  if (probe.shape(1) != pixels || probe.shape(2) != 3 || pixels < 8)
    refuse("an image of a mirror sphere must be square and have 8 pixels a side or more, not " +
           std::to_string(probe.shape(0)) + " x " + std::to_string(probe.shape(1)));
  if (!std::all_of(probe.data(), probe.data() + probe.size(),
                   [](float value) { return std::isfinite(value) && value >= 0.0f; }))
    refuse("an image of a mirror sphere must be finite and not negative");
  if (options.rows == 0 || options.samples < 0)
    refuse("an unwrapped map needs at least one row, and its directions across each pixel must not be negative");
  if (!(options.reflectance > 0.0 && options.reflectance <= 1.0))
    refuse("a mirror's reflectance must be above 0 and up to 1, not " + std::to_string(options.reflectance));
}

GONIO_INLINE rgb read_probe(const image& probe, const Eigen::Vector2d& place) noexcept {
  const double half = static_cast<double>(probe.shape(0)) / 2.0;
  const double rim = 1.0 - 0.75 / half, whole = 1.0 - std::sqrt(0.5) / half, radius = place.norm();
  const Eigen::Vector2d inside = radius > rim ? Eigen::Vector2d(place * (rim / radius)) : place;
  const double column = half * (1.0 + inside.x()) - 0.5, row = half * (1.0 - inside.y()) - 0.5;
  rgb sum = rgb::Zero();
  double weights = 0.0;
  for (const double r : {std::floor(row), std::floor(row) + 1.0})
    for (const double c : {std::floor(column), std::floor(column) + 1.0}) {
      const double weight = (1.0 - std::abs(row - r)) * (1.0 - std::abs(column - c));
      if (!(weight > 0.0) || std::hypot((c + 0.5) / half - 1.0, (r + 0.5) / half - 1.0) > whole) continue;
      sum += weight * pixel(probe, static_cast<std::size_t>(r), static_cast<std::size_t>(c));
      weights += weight;
    }
  return sum / weights;
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE image unwrap(const image& probe, const mirror_sphere& sphere, const unwrap_options& options,
                          thread_count threads) {
  detail::require_unwrappable(probe, options);
  const auto light_from = [&](double polar, double longitude) -> rgb {
    const direction towards{std::sin(polar) * std::sin(longitude), std::cos(polar),
                            -std::sin(polar) * std::cos(longitude)};
    if (const auto place = sphere.place_of(towards)) return detail::read_probe(probe, *place);
    const double across = std::hypot(towards.x(), towards.y());
    return detail::read_probe(
        probe, across > 0.0 ? Eigen::Vector2d(towards.x() / across, towards.y() / across) : Eigen::Vector2d(1.0, 0.0));
  };

  const int samples = options.samples_for(probe.shape(0));
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
                sum += light_from(step * (static_cast<double>(row) + down),
                                  step * (static_cast<double>(column) + across) - std::numbers::pi);
              }
            set_pixel(map, row, column, sum / (samples * samples * options.reflectance));
          }
      },
      threads);
  return map;
}

}  // namespace gonio::capture
