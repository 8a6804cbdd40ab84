#pragma once
/// Converts a close image of a flat sample to measurements of its BRDF. Every pixel has its own viewing direction. Xu,
/// Nielsen, Yu, Jensen and Ramamoorthi 2016 (doi:10.1145/2980179.2982396), sections 5.2 and 7.
///
/// The sample lies in the plane z = 0. A pixel's value is the radiance L, and f = L / (E cos theta_i), where E is the
/// irradiance of a surface that faces the light. With an image of a white reference, the ratio of the two images gives
/// f for each pixel (capture/surface_light.hpp).

#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/surface_light.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/table/image.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace gonio::capture {

/// A disc in the plane of the sample, in the camera's unit of length.
struct sample_disc {
  double radius = 1.0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();

  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const noexcept;
};

/// A rectangle of an image's pixels; the first row is at the top.
struct pixel_window {
  std::size_t column = 0, row = 0, columns = 0, rows = 0;
};

/// How an image was taken, and which pixels are used.
struct near_field_setup {
  lens_camera camera;
  surface_light light;
  /// The region of interest: the pixels that see the disc, or the pixels in the window. If both are given, the pixels
  /// that are in both.
  std::optional<sample_disc> disc = {};
  std::optional<pixel_window> window = {};
  /// For each pixel, row by row, whether to use it, for example a cluster of one material. If empty, all pixels are
  /// used.
  std::vector<bool> mask = {};
  /// Skips pixels with a channel of at least this value, and the blocks that contain them.
  std::optional<double> saturation = {};
  /// Side in pixels of the blocks that are averaged to one sample. Larger blocks give less noise and fewer samples.
  std::size_t block = 1;
  /// For a white image: the reflectance of the white surface, and the plane of the white surface if that differs from
  /// the sample's.
  std::optional<double> white_reflectance = {};
  std::optional<placed_plane> white_plane = {};
};

/// Throws gonio::error unless camera and light are above the sample's plane, the light is usable, the disc, saturation
/// and block size are positive, the mask has the image's size, and the window is inside the image.
void require_usable(const near_field_setup& setup);

namespace detail {

/// A point of the sample, and the direction from this point to the camera.
struct seen_point {
  Eigen::Vector3d position;
  direction view;
};

/// Returns the point of the sample that a pixel sees, if the point is in the disc and the mask contains the pixel. Does
/// not check the window.
[[nodiscard]] std::optional<seen_point> point_of_pixel(const near_field_setup& setup, std::size_t row,
                                                       std::size_t column);

/// The reading of one pixel of the region of interest.
struct near_field_reading {
  direction light, view;
  rgb value;  ///< f in sr^-1
  bool saturated = false;
};

/// Reads one pixel of an image. Returns nothing if the pixel does not see the region of interest, or if the white
/// reference is dark or not visible at this pixel. Throws gonio::error for values that are not finite, unless they are
/// saturated.
[[nodiscard]] std::optional<near_field_reading> read_pixel(const image& picture, const near_field_setup& setup,
                                                           const std::optional<white_reference>& white, std::size_t row,
                                                           std::size_t column);

/// Returns the cones of light and receiver for a block of pixels centred at an image position.
[[nodiscard]] aperture block_aperture(const near_field_setup& setup, double row, double column);

/// Sums over the pixels of a block that see the region of interest.
struct pixel_block {
  rgb values = rgb::Zero();
  direction lights = direction::Zero(), views = direction::Zero();
  std::size_t pixels = 0;
  bool saturated = false;

  void add(const near_field_reading& reading);
};

}  // namespace detail

/// Returns the pixels, row by row, that see the region of interest. Throws gonio::error as `require_usable` does.
[[nodiscard]] std::vector<Eigen::Index> pixels_of_region(const near_field_setup& setup);

/// Returns the reflectance f in sr^-1 of each pixel of `pixels_of_region`; zero if the white reference is dark or not
/// visible. Throws gonio::error as `near_field_samples` does.
[[nodiscard]] std::vector<rgb> region_reflectance(const image& picture, const near_field_setup& setup,
                                                  const std::optional<white_reference>& white = {});

/// Returns one sample for each block of pixels that see the region of interest, row by row from the top left corner of
/// the image or window. Value and directions are the means over these pixels; the weight is their fraction of the
/// block. With a white reference, each pixel's value is divided by the value of the white image, and pixels where the
/// white image is dark are ignored. The sample's cones are those of the light and of the block (`pixel_aperture`).
/// Throws gonio::error as `require_usable` does, if an image's size differs from the camera's, if a pixel of the region
/// is not finite (the message names it), or if all pixels of the sample are invisible or saturated. O(pixels).
/// ```cpp
/// const gonio::directional_light lamp{gonio::spherical_direction(theta_i, 0.0)};
/// const auto samples = gonio::capture::near_field_samples(
///     image, {.camera = camera, .light = lamp, .disc = gonio::capture::sample_disc{0.2}});
/// ```
[[nodiscard]] sample_set near_field_samples(const image& picture, const near_field_setup& setup,
                                            const std::optional<white_reference>& white = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/near_field_image.ipp>
#endif
