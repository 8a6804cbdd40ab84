#pragma once
/// Exposure of images. Images of spheres that are to be compared get the same exposure.

#include <gonio/table/image.hpp>

#include <span>

namespace gonio::render {

/// Returns the quantile `share` (0 to 1) of the brightest channel over a sphere's pixels. `picture` is an image of
/// `render_sphere`; pixels around the sphere are ignored. Throws gonio::error if the image is not square.
[[nodiscard]] double brightness_of_sphere(const image& picture, double share = 0.99);

/// Returns the factor that makes the brightest sphere's 99th percentile white. Brighter pixels, such as a highlight on
/// a hundredth of the sphere, are clipped. Returns 1 if all spheres are black.
[[nodiscard]] double exposure_of_spheres(std::span<const image> images);

/// Returns the factor that makes the 99th percentile of an image white. The percentile is over the brightest channel of
/// the pixels that are not black. From 200,000 pixels on, uses only every n-th pixel. Returns 1 if all are black.
[[nodiscard]] double exposure_of(const image& picture);

/// Multiplies all values.
void expose(image& picture, double exposure);

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/exposure.ipp>
#endif
