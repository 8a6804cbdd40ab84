#pragma once
/// Converts a photograph of a surface of known shape to BRDF measurements, one per pixel: of a sphere (Marschner et al.
/// 2000, doi:10.1364/AO.39.002592; Nielsen et al. 2015, doi:10.1145/2816795.2818085, Sec. 6) or any other shape.
///
/// A pixel's value is the radiance L = f E cos(theta_i). A lamp of intensity I at a distance d has E = I / d^2. With a
/// photograph of a white reference by the same camera and lamp, the ratio gives f for each pixel
/// (capture/surface_light.hpp).

#include <gonio/capture/surface_light.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/table/grid.hpp>
#include <gonio/table/image.hpp>
#include <gonio/table/sample_set.hpp>
#include <gonio/table/surface_image.hpp>

#include <Eigen/Core>

#include <optional>

namespace gonio::capture {

/// Which pixels of a photograph to use, and how to average them.
struct photograph_options {
  /// Skips pixels with a channel of at least this value, in the photograph or the white reference's photograph.
  std::optional<double> saturation = {};
  /// Skips pixels at which the cosine of light or camera is smaller than this.
  double smallest_cosine = 0.05;
  /// Pixels whose half and difference angles are in one cell of this grid are averaged to one sample.
  grid cells = grid({90, 90, 180});
};

/// Samples and statistics of their pixels.
struct photograph_samples {
  sample_set samples;
  Eigen::Index pixels = 0;            ///< used
  Eigen::Index saturated = 0;         ///< number of saturated pixels, which were skipped
  rgb pixel_deviation = rgb::Zero();  ///< relative noise of a pixel, from the scatter in cells
};

/// Returns the samples of a photograph. Skips pixels at the surface's border (with a neighbour that does not see the
/// surface), because they mix surface and background. Averages all pixels whose half and difference angles lie in one
/// cell to one sample: directions, value and cones (`pixel_aperture`). The weight in each channel is `weight_of` the
/// relative deviation of the mean of n pixels, s / sqrt(n), where s is the median scatter of pixels within cells of at
/// least four pixels. Does not detect surfaces that shade themselves.
///
/// Throws gonio::error if a photograph or the reference's surface differs in size from the camera's image, if a pixel
/// of the surface is not a number (the message names it), if the lamp is inside the surface, if the light is a lamp and
/// the surface has no positions, or if no pixel is lit and visible. O(pixels log pixels).
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
