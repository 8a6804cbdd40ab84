#pragma once
/// Images in memory.

#include <gonio/core/arrays.hpp>
#include <gonio/core/assertion.hpp>
#include <gonio/core/rgb.hpp>

#include <algorithm>
#include <cstddef>

namespace gonio {

/// An image of shape (rows, columns, 3), top row first: linear light in Rec. 709 primaries.
using image = xt::xtensor<float, 3>;

/// Returns an image of one colour.
[[nodiscard]] image uniform_image(std::size_t rows, std::size_t columns, const rgb& colour = rgb::Zero());

[[nodiscard]] inline rgb pixel(const image& pixels, std::size_t row, std::size_t column) noexcept {
  GONIO_ASSERT(row < pixels.shape(0) && column < pixels.shape(1));
  const float* value = pixels.data() + 3 * (row * pixels.shape(1) + column);
  return {value[0], value[1], value[2]};
}

inline void set_pixel(image& pixels, std::size_t row, std::size_t column, const rgb& colour) noexcept {
  GONIO_ASSERT(row < pixels.shape(0) && column < pixels.shape(1));
  float* value = pixels.data() + 3 * (row * pixels.shape(1) + column);
  std::ranges::copy(colour.cast<float>(), value);
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/image.ipp>
#endif
