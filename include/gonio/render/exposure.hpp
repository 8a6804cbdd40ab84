#pragma once
/// How bright images are shown: those of spheres that are compared with one another, all alike.

#include <gonio/table/image.hpp>

#include <span>

namespace gonio::render {

/// What a share of a sphere's pixels does not exceed in its brightest channel; `picture` is one of `render_sphere`,
/// whose surroundings do not count. Throws gonio::error if the image is not square.
[[nodiscard]] double brightness_of_sphere(const image& picture, double share = 0.99);

/// The factor at which the brightest of some spheres is white at its 99th percentile: what is brighter, a highlight of
/// a hundredth of the sphere, is clipped. 1 if all are black.
[[nodiscard]] double exposure_of_spheres(std::span<const image> images);

/// The factor at which an image is white at the 99th percentile of its pixels' brightest channels, of those that are
/// not black, or of every n-th, some 100,000. 1 if all are black.
[[nodiscard]] double exposure_of(const image& picture);

/// Multiplies all values.
void expose(image& picture, double exposure);

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/exposure.ipp>
#endif
