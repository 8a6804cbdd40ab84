#pragma once
/// A photograph of a surface of known shape as measurements of its BRDF, one for each pixel: of a sphere (Marschner et
/// al. 2000, doi:10.1364/AO.39.002592; Nielsen et al. 2015, doi:10.1145/2816795.2818085, Sec. 6) or any other.
///
/// A pixel's value is the radiance L = f E cos(theta_i), where a lamp of intensity I at a distance d has E = I / d^2.
/// With a photograph of a white reference by the same camera and lamp, f follows from both for each pixel
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
/// directions, its value and its cones (`pixel_aperture`) are their means. Its weight is, in each channel, `weight_of`
/// the relative deviation of the mean of n pixels, s / sqrt(n), with s the median scatter of pixels within cells of
/// four and more. Surfaces that shade themselves are not known as such.
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
