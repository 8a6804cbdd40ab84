#pragma once
/// The light under which a surface was photographed: a lamp at a position or a distant light. A photograph of a white
/// reference calibrates it.
///
/// A photograph of the reference by the same camera under the same light gives f of the surface for each pixel
/// (Nielsen's thesis 2016, note on relative BRDF measurement, Eq. 20 to 22, `reference_light`). Vignetting, the lamp's
/// falloff and its beam then cancel. Cosine and distance also cancel if the reference has the shape and position of the
/// surface.

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

/// Throws gonio::error if a size differs from the size of the camera's image. `what` is the name in the message.
void require_size(std::size_t columns, std::size_t rows, const camera_intrinsics& size, const char* what);

/// Throws gonio::error if an image differs in size from the camera's image, or if it does not have three channels.
/// `what` is the name in the message.
void require_size(const image& picture, const camera_intrinsics& size, const char* what);

}  // namespace detail

/// A small lamp at a position in the camera's world coordinates.
struct point_lamp {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  rgb intensity = rgb::Ones();  ///< irradiance at distance 1 on a surface that faces the lamp
  double radius = 0.0;
};

/// A lamp at a finite distance, or a distant light with the same direction everywhere.
using surface_light = std::variant<directional_light, point_lamp>;

/// The illumination of a point of a surface.
struct lit_point {
  direction towards;             ///< unit vector towards the light
  rgb irradiance = rgb::Ones();  ///< irradiance of a surface that faces the light
  double distance = 1.0;         ///< 1 for a distant light
  double half_angle = 0.0;       ///< angular radius of the light, radians
};

/// Returns direction, distance and angular radius of the light, as seen from a position.
[[nodiscard]] lit_point light_at(const surface_light& light, const Eigen::Vector3d& position);

/// Returns the cones of light and receiver for a pixel or a block of pixels. The source's cone is the light's. The half
/// vector turns relative to the normal by `across` from the left to the right edge of the pixel, and by `down` from top
/// to bottom. The receiver's cone is the one over which half vectors scatter as much as over the pixel.
[[nodiscard]] aperture pixel_aperture(const lit_point& lit, const Eigen::Vector3d& across, const Eigen::Vector3d& down);

/// Throws gonio::error unless a distant light's direction has length 1, a lamp's position is finite, and the irradiance
/// or intensity is finite and positive in each channel. A lamp's radius must be at least 0, a distant light's half
/// angle from 0 to 45 degrees.
void require_usable(const surface_light& light);

/// A white surface, photographed by the same camera under the same light.
struct white_reference {
  image photograph;
  double reflectance = 1.0;              ///< reflectance of the white surface, which must be matte
  std::optional<surface_image> surface;  ///< empty: the reference has the shape and position of the measured surface
};

/// Throws gonio::error if the reference's photograph or surface differs in size from the camera's image, or if its
/// reflectance is not above 0 and at most 1.
void require_usable(const white_reference& white, const camera_intrinsics& size);

/// Returns the illumination of the reference at a pixel. `here` is the illumination of the measured surface at this
/// pixel. Returns nothing if the reference is not visible at the pixel, or if its cosine is not positive or below
/// `smallest_cosine`.
[[nodiscard]] std::optional<illumination> white_illumination(const white_reference& white, const surface_light& light,
                                                             std::size_t row, std::size_t column,
                                                             const illumination& here, double smallest_cosine);

/// Returns f in sr^-1 of a surface (Eq. 20 to 22), from its illumination `here`, its radiance, and the radiance of the
/// reference, which must be positive.
[[nodiscard]] rgb relative_to_white(const rgb& radiance, const illumination& here, const rgb& white_radiance,
                                    double reflectance, const illumination& of_white);

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/surface_light.ipp>
#endif
