#pragma once
/// Bodies of table/image.hpp.

#include <gonio/core/arrays.hpp>
#include <gonio/core/assertion.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/table/image.hpp>

#include <algorithm>
#include <cstddef>

namespace gonio {

GONIO_INLINE image uniform_image(std::size_t rows, std::size_t columns, const rgb& colour) {
  image pixels({rows, columns, std::size_t{3}});
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels.data()[i] = static_cast<float>(colour[i % 3]);
  return pixels;
}

}  // namespace gonio
