#pragma once
/// Combines several images into one.

#include <gonio/table/image.hpp>

#include <algorithm>
#include <span>

namespace gonio::render {

/// Copies `picture` into `canvas`, with its top left corner at (row, column).
void paste(image& canvas, const image& picture, std::size_t row, std::size_t column);

/// Joins images from left to right, aligned at the top, with `margin` pixels of `background` around each image
/// (neighbours share a margin).
[[nodiscard]] image side_by_side(std::span<const image> images, std::size_t margin = 0,
                                 const rgb& background = rgb::Zero());

/// Joins images from top to bottom, aligned at the left; otherwise like `side_by_side`.
[[nodiscard]] image stacked(std::span<const image> images, std::size_t margin = 0, const rgb& background = rgb::Zero());

}  // namespace gonio::render

#if !defined(GONIO_COMPILED)
#include <gonio/render/impl/image.ipp>
#endif
