#pragma once
/// Converts a photograph of a mirror sphere to the light around it (P. Debevec, "Rendering Synthetic Objects into Real
/// Scenes", SIGGRAPH 1998, doi:10.1145/280814.280864; Nielsen's thesis 2016, note on environment maps, Eq. 1-3).

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

/// A mirror sphere and a camera that looks at its centre. Axes: x to the right and y up in the image, z from the sphere
/// towards the camera. Image coordinates run from -1 to 1 over a sphere of radius 1 that fills the image, y upwards.
class mirror_sphere {
 public:
  /// A camera at infinity: orthographic, as the note assumes.
  mirror_sphere() = default;

  /// A camera at a distance from the centre, in radii of the sphere. Throws gonio::error unless it is more than 1.
  explicit mirror_sphere(double distance);

  /// A camera for which the sphere subtends this angle in radians. Throws gonio::error unless it is between 0 and pi.
  [[nodiscard]] static mirror_sphere spanning(double angle);

  [[nodiscard]] double distance() const noexcept { return distance_; }

  /// Returns the largest angle in radians between the z axis and a light that the camera sees. For a camera at infinity
  /// it is pi; light from directly behind the sphere is spread around its rim. A close camera sees less, because the
  /// sphere hides the light behind it.
  [[nodiscard]] double largest_polar_angle() const noexcept { return std::numbers::pi - std::asin(1.0 / distance_); }

  /// Returns the image position of light from a direction, which need not be of unit length. Returns nothing if the
  /// sphere hides it. Uses about five steps of Newton's method in the plane of light, normal and camera.
  [[nodiscard]] std::optional<Eigen::Vector2d> place_of(const direction& light) const noexcept;

  /// Returns the direction of the light seen at an image position, a unit vector; nothing outside the sphere.
  [[nodiscard]] std::optional<direction> light_at(const Eigen::Vector2d& place) const noexcept;

 private:
  [[nodiscard]] bool is_far() const noexcept { return std::isinf(distance_); }

  /// Returns the angle between z and the line from a point of the sphere to the camera. The normal at the point is at
  /// `angle` from z; the line leans to the other side.
  [[nodiscard]] double leaning(double angle) const noexcept {
    return is_far() ? 0.0 : std::atan2(std::sin(angle), distance_ - std::cos(angle));
  }

  /// Returns the normal's angle from z that reflects light at a polar angle to the camera. It solves 2 a + leaning(a) =
  /// polar, which increases with a.
  [[nodiscard]] double normal_angle(double polar) const noexcept;

  /// Returns the distance from the image centre of the point whose normal is at an angle from z.
  [[nodiscard]] double radius_of(double angle) const noexcept {
    if (is_far()) return std::sin(angle);
    return std::min(1.0, std::sin(angle) / (distance_ - std::cos(angle)) * std::sqrt(distance_ * distance_ - 1.0));
  }

  /// The inverse: the first point of the sphere on the ray through an image position.
  [[nodiscard]] double angle_of(double radius) const noexcept;

  double distance_ = std::numeric_limits<double>::infinity();
};

struct unwrap_options {
  std::size_t rows = 256;    ///< of the map; it has twice as many columns
  double reflectance = 1.0;  ///< of the mirror
  int samples = 0;           ///< directions averaged across a pixel of the map; 0: chosen from the image size

  /// Returns the number of samples that skips no pixel in the middle of an image with `pixels` pixels across, where a
  /// pixel covers 4 / pixels radians of the light's angle.
  [[nodiscard]] int samples_for(std::size_t pixels) const noexcept;
};

namespace detail {

void require_unwrappable(const image& probe, const unwrap_options& options);

/// Returns the colour at a position of the sphere's image by bilinear interpolation. Ignores pixels that lie partly
/// outside the sphere. Positions within three quarters of a pixel of the rim are moved inwards to that distance, so
/// that the inner pixel is always whole.
[[nodiscard]] rgb read_probe(const image& probe, const Eigen::Vector2d& place) noexcept;

}  // namespace detail

/// Converts a square image that the sphere fills to a latitude-longitude image of the light around it, with the
/// conventions of render/environment_map.hpp. For each direction of the map it interpolates the image at the position
/// of that light, ignoring pixels that lie partly outside the sphere. Directions that the sphere hides get the colour
/// at the rim on that side.
///
/// Throws gonio::error unless the image is square, at least 8 pixels wide, finite and not negative, there are rows,
/// samples is not negative, and the reflectance is above 0 and at most 1. O(rows^2 samples^2).
[[nodiscard]] image unwrap(const image& probe, const mirror_sphere& sphere, const unwrap_options& options = {},
                           thread_count threads = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/mirror_sphere.ipp>
#endif
