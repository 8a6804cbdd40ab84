#pragma once
/// Placing several images in one.

#include <gonio/table/image.hpp>

#include <algorithm>
#include <span>

namespace gonio::render {

/// Copies an image into a larger one, its top left corner at (row, column).
void paste(image& canvas, const image& picture, std::size_t row, std::size_t column);

/// Images from left to right, their tops aligned, with `margin` pixels of `background` around each
/// (neighbours share one margin).
[[nodiscard]] image side_by_side(std::span<const image> images, std::size_t margin = 0,
                                 const rgb& background = rgb::Zero());

/// Images from top to bottom, their left sides aligned; otherwise as `side_by_side`.
[[nodiscard]] image stacked(std::span<const image> images, std::size_t margin = 0, const rgb& background = rgb::Zero());

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/image.ipp>
#endif
