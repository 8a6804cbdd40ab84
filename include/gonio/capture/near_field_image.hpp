#pragma once
/// An image of a flat sample, taken from close by, as measurements of its BRDF: every pixel has its own viewing
/// direction. Xu, Nielsen, Yu, Jensen and Ramamoorthi 2016 (doi:10.1145/2980179.2982396), sections 5.2 and 7.
///
/// The sample lies in the plane z = 0. A pixel's value is the radiance L that it sees, so that f = L / (E cos theta_i),
/// where E is the irradiance of a surface that faces the light. With an image of a white reference, f follows from both
/// for each pixel (capture/surface_light.hpp).

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

/// How an image was taken, and what of it counts.
struct near_field_setup {
  lens_camera camera;
  surface_light light;
  /// The region of interest: the pixels that see the disc, those in the window, or if both are given, in both.
  std::optional<sample_disc> disc = {};
  std::optional<pixel_window> window = {};
  /// Whether each pixel counts, row by row, as clusters of materials say it; all do if it is empty.
  std::vector<bool> mask = {};
  /// Pixels with a channel of this value and more are skipped, and so are the blocks that they are in.
  std::optional<double> saturation = {};
  /// Pixels a side of the blocks that are averaged to one sample: less noise, and fewer samples.
  std::size_t block = 1;
  /// What a white image shows, if there is one: its reflectance, and its plane unless it lies where the sample lies.
  std::optional<double> white_reflectance = {};
  std::optional<placed_plane> white_plane = {};
};

/// Throws gonio::error unless camera and light are above the sample's plane, the light is usable, and what can be
/// measured in numbers is positive; a window must be inside the camera's image.
void require_usable(const near_field_setup& setup);

namespace detail {

/// A place of the sample, and the direction from there to the camera.
struct seen_place {
  Eigen::Vector3d position;
  direction view;
};

/// What a pixel sees of the region of interest, the window apart, if anything.
[[nodiscard]] std::optional<seen_place> place_of_pixel(const near_field_setup& setup, std::size_t row,
                                                       std::size_t column);

/// What a pixel of the region says.
struct near_field_reading {
  direction light, view;
  rgb value;  ///< f in sr^-1
  bool saturated = false;
};

/// Reads one pixel of an image. Nothing if it does not see the region, or if the white reference is dark or not seen
/// there. Refuses what is not finite, unless it is saturated.
[[nodiscard]] std::optional<near_field_reading> read_pixel(const image& picture, const near_field_setup& setup,
                                                           const std::optional<white_reference>& white, std::size_t row,
                                                           std::size_t column);

/// The cones of a block of pixels whose middle is at a place of the image.
[[nodiscard]] aperture block_aperture(const near_field_setup& setup, double row, double column);

/// What the pixels of a block that see the region add up to.
struct pixel_block {
  rgb values = rgb::Zero();
  direction lights = direction::Zero(), views = direction::Zero();
  std::size_t pixels = 0;
  bool saturated = false;

  void add(const near_field_reading& reading);
};

}  // namespace detail

/// The numbers, row by row, of the pixels that see the region of interest. Throws gonio::error as `require_usable`
/// does.
[[nodiscard]] std::vector<Eigen::Index> pixels_of_region(const near_field_setup& setup);

/// The reflectance f of each of these pixels, three numbers; zero where the white reference is dark or not seen.
/// Throws gonio::error as `near_field_samples` does.
[[nodiscard]] std::vector<rgb> region_reflectance(const image& picture, const near_field_setup& setup,
                                                  const std::optional<white_reference>& white = {});

/// One sample for each block of pixels that see the region of interest, row by row from the image's (or the
/// window's) top left corner. Value and directions are the means of those pixels, the weight is their share of
/// the block. With a white reference each pixel's value is divided by that of the white image; pixels at which that is
/// dark do not count. A sample's cones are the light's and that of its block (`pixel_aperture`). Throws gonio::error as
/// `require_usable` does, if an image's size is not the camera's, naming a pixel of the region that is not finite, or
/// if nothing of the sample is seen. O(pixels).
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
