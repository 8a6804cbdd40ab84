#pragma once
/// A photographed mirror sphere as the light all around it (P. Debevec, "Rendering Synthetic Objects into Real Scenes",
/// SIGGRAPH 1998, doi:10.1145/280814.280864; Nielsen's thesis 2016, note on environment maps, Eq. 1-3).

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

/// A mirror sphere and the camera that looks at its centre. Axes: x to the right and y up in the image, z from the
/// sphere towards the camera. Places in the image are those of a sphere of radius 1 that fills it: from -1 to 1, y
/// upwards.
class mirror_sphere {
 public:
  /// Seen from far away: orthographic, as the note assumes.
  mirror_sphere() = default;

  /// Seen from a distance in radii of the sphere, centre to camera. Throws gonio::error unless it is more than 1.
  explicit mirror_sphere(double distance);

  /// Seen by a camera for which the sphere spans this angle in radians. Throws gonio::error unless it lies between 0
  /// and pi.
  [[nodiscard]] static mirror_sphere spanning(double angle);

  [[nodiscard]] double distance() const noexcept { return distance_; }

  /// The largest angle in radians from the z axis from which light reaches the camera: pi from far away, where the
  /// light from right behind the sphere is spread around its rim; less from close by, where the sphere hides it.
  [[nodiscard]] double largest_polar_angle() const noexcept { return std::numbers::pi - std::asin(1.0 / distance_); }

  /// Where light from a direction, which need not be of unit length, is seen. Nothing if the sphere hides it. Newton's
  /// method in the plane of light, normal and camera; five steps or so.
  [[nodiscard]] std::optional<Eigen::Vector2d> place_of(const direction& light) const noexcept;

  /// The light that is seen at a place, a unit vector; nothing beside the sphere.
  [[nodiscard]] std::optional<direction> light_at(const Eigen::Vector2d& place) const noexcept;

 private:
  [[nodiscard]] bool is_far() const noexcept { return std::isinf(distance_); }

  /// The angle between z and the way from a point of the sphere to the camera, away from the point's side, where the
  /// normal is at `angle` from z.
  [[nodiscard]] double leaning(double angle) const noexcept {
    return is_far() ? 0.0 : std::atan2(std::sin(angle), distance_ - std::cos(angle));
  }

  /// The normal's angle from z that reflects light at a polar angle to the camera: 2 a + leaning(a) = polar, which
  /// rises with a.
  [[nodiscard]] double normal_angle(double polar) const noexcept;

  /// The place's distance from the middle, of a point whose normal is at an angle from z.
  [[nodiscard]] double radius_of(double angle) const noexcept {
    if (is_far()) return std::sin(angle);
    return std::min(1.0, std::sin(angle) / (distance_ - std::cos(angle)) * std::sqrt(distance_ * distance_ - 1.0));
  }

  /// Its inverse: where the ray through the place meets the sphere first.
  [[nodiscard]] double angle_of(double radius) const noexcept;

  double distance_ = std::numeric_limits<double>::infinity();
};

struct unwrap_options {
  std::size_t rows = 256;    ///< of the map, which is twice as wide
  double reflectance = 1.0;  ///< of the mirror
  int samples = 0;  ///< directions across a pixel of the map, of which the mean is taken; 0: as its light needs

  /// As many as it takes not to step over a pixel of the middle of an image that is some pixels wide, where one shows
  /// 4 / pixels of light's angle.
  [[nodiscard]] int samples_for(std::size_t pixels) const noexcept;
};

namespace detail {

void require_unwrappable(const image& probe, const unwrap_options& options);

/// The colour at a place of the sphere's image: the mean of the four pixels around it by how close they are, without
/// those that lie partly beside the sphere. Places within three quarters of a pixel of the rim are moved there, so that
/// the pixel towards the middle is always whole.
[[nodiscard]] rgb read_probe(const image& probe, const Eigen::Vector2d& place) noexcept;

}  // namespace detail

/// The light around a mirror sphere as a latitude-longitude image with the conventions of render/environment_map.hpp,
/// from a square image that the sphere fills. For each direction of the map the image is read, between its pixels,
/// where it shows that light, without pixels that lie partly beside the sphere. What the sphere hides, right behind it,
/// is filled with what is seen at the rim on that side.
///
/// Throws gonio::error unless the image is square, of at least 8 pixels a side, finite and not negative, and the
/// options are positive, the reflectance at most 1. O(rows^2 samples^2).
[[nodiscard]] image unwrap(const image& probe, const mirror_sphere& sphere, const unwrap_options& options = {},
                           thread_count threads = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/mirror_sphere.ipp>
#endif
