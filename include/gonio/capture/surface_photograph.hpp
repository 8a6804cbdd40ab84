#pragma once
/// A photograph of a surface of known shape as measurements of its BRDF, one for each pixel: of a sphere (Marschner et
/// al. 2000, doi:10.1364/AO.39.002592; Nielsen et al. 2015, doi:10.1145/2816795.2818085, Sec. 6) or any other.
///
/// A pixel's value is the radiance L = f E cos(theta_i), where a lamp of intensity I at a distance d has E = I / d^2.
/// With a photograph of a white reference by the same camera and lamp, f follows from both for each pixel (Nielsen's
/// thesis 2016, note on relative BRDF measurement, Eq. 20 to 22, `reference_light`). Vignetting, the lamp's falloff and
/// its beam then cancel, and so do cosine and distance where the reference has the shape of the surface.

#include <gonio/core/directional_light.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/table/grid.hpp>
#include <gonio/table/image.hpp>
#include <gonio/table/sample_set.hpp>
#include <gonio/table/surface_image.hpp>

#include <Eigen/Core>

#include <optional>
#include <variant>

namespace gonio::capture {

/// A small lamp at a place of the camera's world.
struct point_lamp {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  rgb intensity = rgb::Ones();  ///< irradiance at distance 1 of a surface that faces the lamp
};

/// A lamp at a finite distance, or one so far away that its direction is the same everywhere.
using surface_light = std::variant<directional_light, point_lamp>;

namespace detail {

/// How a point of a surface is lit.
struct lit_point {
  direction towards;             ///< the light
  rgb irradiance = rgb::Ones();  ///< of a surface that faces it
  double distance = 1.0;         ///< 1 of a distant light
};

[[nodiscard]] lit_point light_at(const surface_light& light, const Eigen::Vector3d& position);

}  // namespace detail

/// What a white surface looked like under the same lamp, by the same camera.
struct white_reference {
  image photograph;
  double reflectance = 1.0;              ///< of a surface that reflects evenly
  std::optional<surface_image> surface;  ///< none: the reference has the shape and the place of the surface itself
};

/// What of a photograph counts, and how it is averaged.
struct photograph_options {
  /// Pixels with a channel of this value and more are skipped, in either photograph.
  std::optional<double> saturation = {};
  /// Pixels at which light or camera have a smaller cosine are skipped.
  double smallest_cosine = 0.05;
  /// Pixels of one cell of these are averaged to one sample.
  grid cells = grid({90, 90, 180});
};

/// Samples, and what they are made of.
struct photograph_samples {
  sample_set samples;
  Eigen::Index pixels = 0;            ///< that count
  Eigen::Index saturated = 0;         ///< that do not
  rgb pixel_deviation = rgb::Zero();  ///< relative noise of a pixel, as neighbours in a cell scatter
};

/// The samples of a photograph. Pixels at the surface's border, with a neighbour that does not see it, are skipped:
/// what they see is mixed. All pixels whose half and difference angles lie in one cell are averaged to one sample: its
/// directions and its value are their means. Its weight is, in each channel, `weight_of` the relative deviation of the
/// mean of n pixels, s / sqrt(n), with s the median scatter of pixels within cells of four and more. Surfaces that
/// shade themselves are not known as such.
///
/// Throws gonio::error if a photograph or the reference's surface has another size than the camera's image, naming a
/// pixel of the surface that is not a number, if the lamp is inside the surface, if a surface has no positions that the
/// lamp needs, or if no pixel is lit and seen. O(pixels log pixels).
/// ```cpp
/// const auto found = gonio::capture::find_sphere(photograph, camera, 0.05);
/// const auto surface = gonio::capture::surface_of(found.sphere, camera);
/// const auto samples = gonio::capture::samples_of(photograph, surface, camera, lamp, white).samples;
/// ```
[[nodiscard]] photograph_samples samples_of(const image& photograph, const surface_image& surface,
                                            const lens_camera& camera, const surface_light& light,
                                            const std::optional<white_reference>& white = {},
                                            const photograph_options& options = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/surface_photograph.ipp>
#endif
