#pragma once
/// Bodies of render/image.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/render/image.hpp>
#include <gonio/table/image.hpp>

#include <algorithm>
#include <span>

namespace gonio::render {

GONIO_INLINE void paste(image& canvas, const image& picture, std::size_t row, std::size_t column) {
  GONIO_ASSERT(row + picture.shape(0) <= canvas.shape(0) && column + picture.shape(1) <= canvas.shape(1));
  const std::size_t width = 3 * picture.shape(1);
  for (std::size_t r = 0; r < picture.shape(0); ++r)
    std::copy_n(picture.data() + r * width, width, canvas.data() + 3 * ((row + r) * canvas.shape(1) + column));
}

GONIO_INLINE image side_by_side(std::span<const image> images, std::size_t margin, const rgb& background) {
  std::size_t rows = 0, columns = margin;
  for (const image& picture : images) {
    rows = std::max(rows, picture.shape(0));
    columns += picture.shape(1) + margin;
  }
  image canvas = uniform_image(rows + 2 * margin, columns, background);
  std::size_t column = margin;
  for (const image& picture : images) {
    paste(canvas, picture, margin, column);
    column += picture.shape(1) + margin;
  }
  return canvas;
}

GONIO_INLINE image stacked(std::span<const image> images, std::size_t margin, const rgb& background) {
  std::size_t rows = margin, columns = 0;
  for (const image& picture : images) {
    rows += picture.shape(0) + margin;
    columns = std::max(columns, picture.shape(1));
  }
  image canvas = uniform_image(rows, columns + 2 * margin, background);
  std::size_t row = margin;
  for (const image& picture : images) {
    paste(canvas, picture, row, margin);
    row += picture.shape(0) + margin;
  }
  return canvas;
}

}  // namespace gonio::render
