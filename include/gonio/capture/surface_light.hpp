#pragma once
/// The light under which a surface was photographed: a lamp at a place or a distant light, and what a photograph of a
/// white reference says of it.
///
/// With such a photograph by the same camera under the same light, f of a surface follows for each pixel (Nielsen's
/// thesis 2016, note on relative BRDF measurement, Eq. 20 to 22, `reference_light`). Vignetting, the lamp's falloff and
/// its beam then cancel, and so do cosine and distance where the reference has the shape and the place of the surface.

#include <gonio/capture/relative_reflectance.hpp>
#include <gonio/core/directional_light.hpp>
#include <gonio/core/pinhole_camera.hpp>
#include <gonio/table/aperture.hpp>
#include <gonio/table/image.hpp>
#include <gonio/table/surface_image.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <variant>

namespace gonio::capture {

namespace detail {

/// Refuses what has another size than the camera's image, and calls it `what`.
void require_size(std::size_t columns, std::size_t rows, const camera_intrinsics& size, const char* what);

/// The same of an image, which must have three channels.
void require_size(const image& picture, const camera_intrinsics& size, const char* what);

}  // namespace detail

/// A small lamp at a place of the camera's world.
struct point_lamp {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  rgb intensity = rgb::Ones();  ///< irradiance at distance 1 of a surface that faces the lamp
  double radius = 0.0;
};

/// A lamp at a finite distance, or one so far away that its direction is the same everywhere.
using surface_light = std::variant<directional_light, point_lamp>;

/// How a point of a surface is lit.
struct lit_point {
  direction towards;             ///< the light
  rgb irradiance = rgb::Ones();  ///< of a surface that faces it
  double distance = 1.0;         ///< 1 of a distant light
  double half_angle = 0.0;       ///< under which the light is seen, radians
};

[[nodiscard]] lit_point light_at(const surface_light& light, const Eigen::Vector3d& position);

/// The cones of a pixel, or of a block of pixels: the source's is the light's. From the left to the right of what it
/// sees of the surface the half vector turns against the normal by `across`, from top to bottom by `down`; the
/// receiver's cone has half vectors that scatter as much.
[[nodiscard]] aperture pixel_aperture(const lit_point& lit, const Eigen::Vector3d& across, const Eigen::Vector3d& down);

/// Throws gonio::error unless the direction of a distant light has length 1, the place of a lamp is finite, and what
/// they send is finite and positive in each channel; a lamp's radius and a distant light's half angle are at least 0,
/// the half angle at most 45 degrees.
void require_usable(const surface_light& light);

/// What a white surface looked like under the same light, by the same camera.
struct white_reference {
  image photograph;
  double reflectance = 1.0;              ///< of a surface that reflects evenly
  std::optional<surface_image> surface;  ///< none: the reference has the shape and the place of the surface itself
};

/// Throws gonio::error if the photograph or the surface of the reference has another size than the camera's image, or
/// if its reflectance is not above 0 and up to 1.
void require_usable(const white_reference& white, const camera_intrinsics& size);

/// How the reference is lit at a pixel where the surface is lit like `here`. Nothing if it is not seen there, or lit at
/// a cosine below the smallest.
[[nodiscard]] std::optional<illumination> white_illumination(const white_reference& white, const surface_light& light,
                                                             std::size_t row, std::size_t column,
                                                             const illumination& here, double smallest_cosine);

/// f in sr^-1 of a surface that is lit like `here`, by its radiance and that of the reference, which is positive
/// (Eq. 20 to 22).
[[nodiscard]] rgb relative_to_white(const rgb& radiance, const illumination& here, const rgb& white_radiance,
                                    double reflectance, const illumination& of_white);

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/surface_light.ipp>
#endif
