#pragma once
/// Converts photographs of a mirror sphere to one map of the light around it (P. Debevec, "Rendering Synthetic Objects
/// into Real Scenes", SIGGRAPH 1998, doi:10.1145/280814.280864; Nielsen's thesis 2016, note on environment maps, Eq. 1
/// to 4, and 8 and 9 for a camera in any direction). Photographs from several directions are merged: each direction of
/// light comes mostly from the photographs that resolve it, so that neither the seam behind the sphere nor the
/// photographer remains.

#include <gonio/capture/mirror_sphere.hpp>
#include <gonio/capture/outline_circle.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <span>

namespace gonio::capture {

/// A photograph of a mirror sphere near the middle of the image, and the camera's direction.
struct light_probe {
  image photograph;  ///< linear radiance
  mirror_sphere sphere = {};
  outline_circle outline = {};  ///< of the sphere in the photograph
  /// World directions to the right and upwards in the image, and from the sphere towards the camera: columns.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double photographer = 0.0;  ///< angle in radians around the camera's direction that camera and photographer hide

  /// Throws gonio::error unless the outline is within the image and at least 8 pixels wide, its pixels are finite, the
  /// axes are a rotation, and the photographer's angle is from 0 to a right angle.
  void require_usable() const;
};

/// Returns the outline of a sphere that fills the image. Throws gonio::error unless the image is square.
[[nodiscard]] outline_circle filled_outline(const image& photograph);

/// Finds a sphere in front of a uniform background by `edge_points`, to a fraction of a pixel. Throws gonio::error as
/// `edge_points` and `fit_sphere` do.
[[nodiscard]] outline_circle find_outline(const image& photograph);

/// Returns the axes of a camera in a direction from the sphere: azimuth from +z towards +x, elevation towards +y, in
/// radians. Its horizon is level (Eq. 8), or turned clockwise in the image by `roll`. Throws gonio::error unless all
/// are finite.
[[nodiscard]] Eigen::Matrix3d camera_axes(double azimuth, double elevation, double roll = 0.0);

struct unwrap_options {
  std::size_t rows = 256;    ///< rows of the map; it has twice as many columns
  double reflectance = 1.0;  ///< reflectance of the mirror
  int samples = 0;           ///< directions averaged across a pixel of the map; 0: chosen from the image size

  /// Returns the number of samples for a sphere of `pixels` pixels across. If chosen from this size, it is from 2 to
  /// 32, enough to skip no pixel in the middle of the sphere, where a pixel covers 4 / pixels radians of the light's
  /// angle.
  [[nodiscard]] int samples_for(std::size_t pixels) const noexcept;
};

namespace detail {

/// Returns the colour at a position of the sphere's image by bilinear interpolation. Ignores pixels that lie partly
/// outside the sphere. Positions less than three quarters of a pixel from the rim are moved inwards to that distance,
/// and further by quarters of a pixel until one of the four pixels is whole.
[[nodiscard]] rgb read_probe(const light_probe& probe, const Eigen::Vector2d& position) noexcept;

/// Returns the colour of the light from a world direction. Directions that the sphere hides get the colour at the rim
/// on that side.
[[nodiscard]] rgb light_from(const light_probe& probe, const direction& towards) noexcept;

/// Returns the weight of a probe for light from a world direction: the fourth power of its lowest resolution there, in
/// pixels per radian of polar angle; 0 for light that the sphere or the photographer hides. Beside the photographer,
/// the weight rises from 0 to its full value over half the photographer's angle. Of the powers 1, 2, 4, 8 and 16, the
/// fourth gives the smallest or nearly the smallest error for cameras 90 to 180 degrees apart, aligned or up to 3
/// degrees off.
[[nodiscard]] double probe_weight(const light_probe& probe, const direction& towards) noexcept;

}  // namespace detail

/// Converts probes to a latitude-longitude image of the light, with the conventions of render/environment_map.hpp. For
/// each direction of the map it interpolates each photograph at the position of that light and takes the mean, weighted
/// by `detail::probe_weight`. Directions that are hidden in all photographs get the mean colour of the rims and
/// photographers. Values below 0, noise, become 0.
///
/// Throws gonio::error unless there is a probe and a row, samples is not negative, the reflectance is above 0 and at
/// most 1, and all probes are usable. O(probes rows^2 samples^2).
[[nodiscard]] image unwrap(std::span<const light_probe> probes, const unwrap_options& options = {},
                           thread_count threads = {});

/// Does the same with one square image that the sphere fills, and a camera at +z.
[[nodiscard]] image unwrap(const image& probe, const mirror_sphere& sphere, const unwrap_options& options = {},
                           thread_count threads = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/light_probe.ipp>
#endif
