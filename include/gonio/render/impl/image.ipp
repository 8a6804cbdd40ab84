#pragma once
/// Bodies of render/image.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/render/image.hpp>
#include <gonio/table/image.hpp>

#include <algorithm>
#include <span>

namespace gonio::render {

GONIO_INLINE void paste(image& canvas, const image& image, std::size_t row, std::size_t column) {
  GONIO_ASSERT(row + image.shape(0) <= canvas.shape(0) && column + image.shape(1) <= canvas.shape(1));
  const std::size_t width = 3 * image.shape(1);
  for (std::size_t r = 0; r < image.shape(0); ++r)
    std::copy_n(image.data() + r * width, width, canvas.data() + 3 * ((row + r) * canvas.shape(1) + column));
}

GONIO_INLINE image side_by_side(std::span<const image> images, std::size_t margin, const rgb& background) {
  std::size_t rows = 0, columns = margin;
  for (const image& image : images) {
    rows = std::max(rows, image.shape(0));
    columns += image.shape(1) + margin;
  }
  image canvas = uniform_image(rows + 2 * margin, columns, background);
  std::size_t column = margin;
  for (const image& image : images) {
    paste(canvas, image, margin, column);
    column += image.shape(1) + margin;
  }
  return canvas;
}

GONIO_INLINE image stacked(std::span<const image> images, std::size_t margin, const rgb& background) {
  std::size_t rows = margin, columns = 0;
  for (const image& image : images) {
    rows += image.shape(0) + margin;
    columns = std::max(columns, image.shape(1));
  }
  image canvas = uniform_image(rows, columns + 2 * margin, background);
  std::size_t row = margin;
  for (const image& image : images) {
    paste(canvas, image, row, margin);
    row += image.shape(0) + margin;
  }
  return canvas;
}

}  // namespace gonio::render
