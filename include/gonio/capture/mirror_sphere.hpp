#pragma once
/// A photographed mirror sphere as the light all around it (P. Debevec, "Rendering Synthetic Objects into Real Scenes",
/// SIGGRAPH 1998; Nielsen's thesis 2016, note on environment maps, Eq. 1-3).

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

namespace gonio {

/// A mirror sphere and the camera that looks at its centre. Axes: x to the right and y up in the picture, z from the
/// sphere towards the camera. Places in the picture are those of a sphere of radius 1 that fills it: from -1 to 1, y
/// upwards.
class mirror_sphere {
 public:
  /// Seen from far away: orthographic, as the note assumes.
  mirror_sphere() = default;

  /// Seen from a distance in radii of the sphere, centre to camera. Throws gonio::error unless it is more than 1.
  explicit mirror_sphere(double distance) : distance_(distance) {
    if (!(distance > 1.0))
      throw error("the camera must stand outside the mirror sphere, more than one radius from its centre, not " +
                  std::to_string(distance));
  }

  /// Seen by a camera for which the sphere spans this angle in radians. Throws gonio::error unless it lies between 0
  /// and pi.
  [[nodiscard]] static mirror_sphere spanning(double angle) {
    if (!(angle > 0.0 && angle < std::numbers::pi))
      throw error("a mirror sphere spans an angle between 0 and 180 degrees, not " + std::to_string(degrees(angle)));
    return mirror_sphere(1.0 / std::sin(angle / 2.0));
  }

  [[nodiscard]] double distance() const noexcept { return distance_; }

  /// The largest angle in radians from the z axis from which light reaches the camera: pi from far away, where the
  /// light from right behind the sphere is spread around its rim; less from close by, where the sphere hides it.
  [[nodiscard]] double largest_polar_angle() const noexcept { return std::numbers::pi - std::asin(1.0 / distance_); }

  /// Where light from a direction, which need not be of unit length, is seen. Nothing if the sphere hides it. Newton's
  /// method in the plane of light, normal and camera; five steps or so.
  [[nodiscard]] std::optional<Eigen::Vector2d> place_of(const direction& light) const noexcept {
    const double across = std::hypot(light.x(), light.y()), polar = std::atan2(across, light.z());
    if (polar > largest_polar_angle()) return {};
    const double radius = radius_of(normal_angle(polar));
    if (!(across > 0.0)) return Eigen::Vector2d(polar > 1.0 ? 1.0 : 0.0, 0.0);
    return Eigen::Vector2d(light.x(), light.y()) * (radius / across);
  }

  /// The light that is seen at a place, a unit vector; nothing beside the sphere.
  [[nodiscard]] std::optional<direction> light_at(const Eigen::Vector2d& place) const noexcept {
    const double radius = place.norm();
    if (!(radius <= 1.0)) return {};
    const double angle = angle_of(radius), polar = 2.0 * angle + leaning(angle);
    const Eigen::Vector2d across =
        radius > 0.0 ? Eigen::Vector2d(place * (std::sin(polar) / radius)) : Eigen::Vector2d::Zero();
    return direction(across.x(), across.y(), std::cos(polar));
  }

 private:
  [[nodiscard]] bool is_far() const noexcept { return std::isinf(distance_); }

  /// The angle between z and the way from a point of the sphere to the camera, away from the point's side, where the
  /// normal is at `angle` from z.
  [[nodiscard]] double leaning(double angle) const noexcept {
    return is_far() ? 0.0 : std::atan2(std::sin(angle), distance_ - std::cos(angle));
  }

  /// The normal's angle from z that reflects light at a polar angle to the camera: 2 a + leaning(a) = polar, which
  /// rises with a.
  [[nodiscard]] double normal_angle(double polar) const noexcept {
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

  /// The place's distance from the middle, of a point whose normal is at an angle from z.
  [[nodiscard]] double radius_of(double angle) const noexcept {
    if (is_far()) return std::sin(angle);
    return std::min(1.0, std::sin(angle) / (distance_ - std::cos(angle)) * std::sqrt(distance_ * distance_ - 1.0));
  }

  /// Its inverse: where the ray through the place meets the sphere first.
  [[nodiscard]] double angle_of(double radius) const noexcept {
    if (is_far()) return std::asin(radius);
    const double view = std::atan(radius / std::sqrt(distance_ * distance_ - 1.0));
    return std::asin(std::min(1.0, distance_ * std::sin(view))) - view;
  }

  double distance_ = std::numeric_limits<double>::infinity();
};

struct unwrap_options {
  std::size_t rows = 256;    ///< of the map, which is twice as wide
  double reflectance = 1.0;  ///< of the mirror
  int samples = 0;  ///< directions across a pixel of the map, of which the mean is taken; 0: as its light needs

  /// As many as it takes not to step over a pixel of the middle of a picture that is some pixels wide, where one shows
  /// 4 / pixels of light's angle.
  [[nodiscard]] int samples_for(std::size_t pixels) const noexcept {
    if (samples > 0) return samples;
    const double needed = std::numbers::pi * static_cast<double>(pixels) / (4.0 * static_cast<double>(rows));
    return std::clamp(static_cast<int>(std::ceil(needed)), 2, 32);
  }
};

namespace detail {

inline void require_unwrappable(const image& probe, const unwrap_options& options) {
  const std::size_t pixels = probe.shape(0);
  if (probe.shape(1) != pixels || probe.shape(2) != 3 || pixels < 8)
    throw error("a picture of a mirror sphere must be square and have 8 pixels a side or more, not " +
                std::to_string(probe.shape(0)) + " x " + std::to_string(probe.shape(1)));
  if (!std::all_of(probe.data(), probe.data() + probe.size(),
                   [](float value) { return std::isfinite(value) && value >= 0.0f; }))
    throw error("a picture of a mirror sphere must be finite and not negative");
  if (options.rows == 0 || options.samples < 0)
    throw error("an unwrapped map needs rows, and no negative number of directions across each pixel");
  if (!(options.reflectance > 0.0 && options.reflectance <= 1.0))
    throw error("a mirror's reflectance lies above 0 and up to 1, not " + std::to_string(options.reflectance));
}

/// The colour at a place of the sphere's picture: the mean of the four pixels around it by how close they are, without
/// those that lie partly beside the sphere. Places within three quarters of a pixel of the rim are moved there, so that
/// the pixel towards the middle is always whole.
[[nodiscard]] inline rgb read_probe(const image& probe, const Eigen::Vector2d& place) noexcept {
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

}  // namespace detail

/// The light around a mirror sphere as a latitude-longitude picture with the conventions of render/environment_map.hpp,
/// from a square picture that the sphere fills. For each direction of the map the picture is read, between its pixels,
/// where it shows that light, without pixels that lie partly beside the sphere. What the sphere hides, right behind it,
/// is filled with what is seen at the rim on that side.
///
/// Throws gonio::error unless the picture is square, of at least 8 pixels a side, finite and not negative, and the
/// options are positive, the reflectance at most 1. O(rows^2 samples^2).
[[nodiscard]] inline image unwrap(const image& probe, const mirror_sphere& sphere, const unwrap_options& options = {},
                                  thread_count threads = {}) {
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
        for (std::size_t row = rows.begin; row < rows.end; ++row)
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

}  // namespace gonio
