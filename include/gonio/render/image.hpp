#pragma once
/// Pictures in memory, and placing several of them in one.

#include <gonio/core/assertion.hpp>
#include <gonio/core/rgb.hpp>

#include <xtensor/xtensor.hpp>

#include <algorithm>
#include <span>

namespace gonio {

/// A picture of shape (rows, columns, 3), top row first: linear light in Rec. 709 primaries.
using image = xt::xtensor<float, 3>;

/// A picture of one colour.
[[nodiscard]] inline image uniform_image(std::size_t rows, std::size_t columns, const rgb& colour = rgb::Zero()) {
  image picture({rows, columns, std::size_t{3}});
  for (std::size_t i = 0; i < picture.size(); ++i)
    picture.data()[i] = static_cast<float>(colour[static_cast<Eigen::Index>(i % 3)]);
  return picture;
}

[[nodiscard]] inline rgb pixel(const image& picture, std::size_t row, std::size_t column) noexcept {
  GONIO_ASSERT(row < picture.shape(0) && column < picture.shape(1));
  const float* value = picture.data() + 3 * (row * picture.shape(1) + column);
  return {value[0], value[1], value[2]};
}

inline void set_pixel(image& picture, std::size_t row, std::size_t column, const rgb& colour) noexcept {
  GONIO_ASSERT(row < picture.shape(0) && column < picture.shape(1));
  float* value = picture.data() + 3 * (row * picture.shape(1) + column);
  std::ranges::copy(colour.cast<float>(), value);
}

/// Copies a picture into a larger one, its top left corner at (row, column).
inline void paste(image& canvas, const image& picture, std::size_t row, std::size_t column) {
  GONIO_ASSERT(row + picture.shape(0) <= canvas.shape(0) && column + picture.shape(1) <= canvas.shape(1));
  const std::size_t width = 3 * picture.shape(1);
  for (std::size_t r = 0; r < picture.shape(0); ++r)
    std::copy_n(picture.data() + r * width, width, canvas.data() + 3 * ((row + r) * canvas.shape(1) + column));
}

/// Pictures from left to right, their tops aligned, with `margin` pixels of `background` around each
/// (neighbours share one margin).
[[nodiscard]] inline image side_by_side(std::span<const image> pictures, std::size_t margin = 0,
                                        const rgb& background = rgb::Zero()) {
  std::size_t rows = 0, columns = margin;
  for (const image& picture : pictures) {
    rows = std::max(rows, picture.shape(0));
    columns += picture.shape(1) + margin;
  }
  image canvas = uniform_image(rows + 2 * margin, columns, background);
  std::size_t column = margin;
  for (const image& picture : pictures) {
    paste(canvas, picture, margin, column);
    column += picture.shape(1) + margin;
  }
  return canvas;
}

/// Pictures from top to bottom, their left sides aligned; otherwise as `side_by_side`.
[[nodiscard]] inline image stacked(std::span<const image> pictures, std::size_t margin = 0,
                                   const rgb& background = rgb::Zero()) {
  std::size_t rows = margin, columns = 0;
  for (const image& picture : pictures) {
    rows += picture.shape(0) + margin;
    columns = std::max(columns, picture.shape(1));
  }
  image canvas = uniform_image(rows, columns + 2 * margin, background);
  std::size_t row = margin;
  for (const image& picture : pictures) {
    paste(canvas, picture, row, margin);
    row += picture.shape(0) + margin;
  }
  return canvas;
}

}  // namespace gonio
