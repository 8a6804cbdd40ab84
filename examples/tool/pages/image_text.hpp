#pragma once
/// Text in images: the bitmap font of stb_easy_font.h (ASCII, Debian's libstb-dev).

#include <gonio/core/rgb.hpp>
#include <gonio/render/image.hpp>

#include <cstddef>
#include <string>

namespace cli {

/// How many rows and columns text takes, a point of the font being `scale` pixels.
struct text_extent {
  std::size_t rows = 0, columns = 0;
};
[[nodiscard]] text_extent extent_of(const std::string& text, std::size_t scale);

/// Draws text whose upper left corner is at a row and a column; what is outside of the image is cut off. Bytes that are
/// not printable ASCII become question marks.
void draw_text(gonio::image& canvas, std::size_t row, std::size_t column, std::string text, std::size_t scale,
               const gonio::rgb& colour);

}  // namespace cli
