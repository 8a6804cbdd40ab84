#pragma once
/// Exposure of images: spheres that are compared all have the same exposure.

#include <gonio/table/image.hpp>

#include <span>

namespace gonio::render {

/// Returns the quantile `share` of the brightest channel over a sphere's pixels. `picture` is an image of
/// `render_sphere`; pixels around the sphere are ignored. Throws gonio::error if the image is not square.
[[nodiscard]] double brightness_of_sphere(const image& picture, double share = 0.99);

/// Returns the factor that makes the 99th percentile of the brightest sphere white. Brighter pixels, a highlight of a
/// hundredth of the sphere, are clipped. 1 if all are black.
[[nodiscard]] double exposure_of_spheres(std::span<const image> images);

/// Returns the factor that makes the 99th percentile of an image white. Uses the brightest channel of the pixels that
/// are not black, or of every n-th pixel if there are more than 100,000. 1 if all are black.
[[nodiscard]] double exposure_of(const image& picture);

/// Multiplies all values.
void expose(image& picture, double exposure);

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/exposure.ipp>
#endif
