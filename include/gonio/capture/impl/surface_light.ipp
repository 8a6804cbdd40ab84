#pragma once
/// Bodies of capture/surface_light.hpp.

#include <gonio/capture/relative_reflectance.hpp>
#include <gonio/capture/surface_light.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/pinhole_camera.hpp>
#include <gonio/table/image.hpp>
#include <gonio/table/surface_image.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <variant>

namespace gonio::capture::detail {

GONIO_INLINE void require_size(std::size_t columns, std::size_t rows, const camera_intrinsics& size, const char* what) {
  if (columns == size.columns && rows == size.rows) return;
  gonio::refuse({what, " has ", columns, " x ", rows, " pixels, but its camera ", size.columns, " x ", size.rows});
}

GONIO_INLINE void require_size(const image& picture, const camera_intrinsics& size, const char* what) {
  if (picture.shape(2) != 3) gonio::refuse({what, " has ", picture.shape(2), " channels, expected 3"});
  require_size(picture.shape(1), picture.shape(0), size, what);
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE lit_point light_at(const surface_light& light, const Eigen::Vector3d& position) {
  if (const auto* distant = std::get_if<directional_light>(&light))
    return {distant->towards, distant->irradiance, 1.0, distant->half_angle};
  const point_lamp& lamp = std::get<point_lamp>(light);
  const Eigen::Vector3d away = lamp.position - position;
  const double distance = away.norm();
  return {away / distance, lamp.intensity / (distance * distance), distance, std::atan2(lamp.radius, distance)};
}

GONIO_INLINE aperture pixel_aperture(const lit_point& lit, const Eigen::Vector3d& across, const Eigen::Vector3d& down) {
  // Give the receiver's cone the same scatter of half vectors as the pixel. The variance over a disc is half its
  // squared radius; over a parallelogram it is a twelfth of the sum of its squared sides. If the viewer turns by an
  // angle, the half vector turns by half that angle.
  const double of_half_vectors = std::sqrt((across.squaredNorm() + down.squaredNorm()) / 6.0);
  return {std::min(lit.half_angle, largest_half_angle), std::min(2.0 * of_half_vectors, largest_half_angle)};
}

GONIO_INLINE void require_usable(const surface_light& light) {
  const auto require = [](bool usable, const char* what) {
    if (!usable) gonio::refuse(what);
  };
  const auto positive = [](const rgb& all) { return all.isFinite().all() && (all > 0.0).all(); };
  if (const auto* distant = std::get_if<directional_light>(&light)) {
    require(std::abs(distant->towards.norm() - 1.0) < 1e-6, "the light's direction must have length 1");
    require(positive(distant->irradiance), "the light's irradiance must be finite and positive in each channel");
    require(distant->half_angle >= 0.0 && distant->half_angle <= largest_half_angle,
            "the light's half angle must be from 0 to 45 degrees");
    return;
  }
  const point_lamp& lamp = std::get<point_lamp>(light);
  require(lamp.position.allFinite(), "the lamp's position must be finite");
  require(positive(lamp.intensity), "the lamp's intensity must be finite and positive in each channel");
  require(std::isfinite(lamp.radius) && lamp.radius >= 0.0, "the lamp's radius must be finite and not negative");
}

GONIO_INLINE void require_usable(const white_reference& white, const camera_intrinsics& size) {
  detail::require_size(white.photograph, size, "the white image");
  if (white.surface)
    detail::require_size(white.surface->columns, white.surface->rows, size, "the white reference's surface");
  if (!(white.reflectance > 0.0 && white.reflectance <= 1.0))
    refuse({"a white reference's reflectance must be above 0 and up to 1, not ", white.reflectance});
}

GONIO_INLINE std::optional<illumination> white_illumination(const white_reference& white, const surface_light& light,
                                                            std::size_t row, std::size_t column,
                                                            const illumination& here, double smallest_cosine) {
  if (!white.surface) return here;
  const Eigen::Index number = white.surface->pixel(row, column);
  if (!white.surface->sees(number)) return {};
  const Eigen::Vector3d normal = white.surface->normals.col(number);
  const lit_point lit = light_at(light, white.surface->positions.col(number));
  const double cosine = normal.dot(lit.towards);
  if (!(cosine > 0.0 && cosine >= smallest_cosine)) return {};
  return illumination{cosine, lit.distance};
}

GONIO_INLINE rgb relative_to_white(const rgb& radiance, const illumination& here, const rgb& white_radiance,
                                   double reflectance, const illumination& of_white) {
  // Rounding may make a cosine exceed 1.
  const auto bounded = [](const illumination& at) { return illumination{std::min(at.cosine, 1.0), at.distance}; };
  rgb value;
  for (Eigen::Index c = 0; c < 3; ++c)
    value[c] =
        reference_light({white_radiance[c]}, reflectance, bounded(of_white)).brdf({radiance[c]}, bounded(here)).value;
  return value;
}

}  // namespace gonio::capture
