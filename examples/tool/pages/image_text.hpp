#pragma once
/// Text in images: the bitmap font of stb_easy_font.h (ASCII, Debian's libstb-dev).

#include <gonio/core/rgb.hpp>
#include <gonio/render/image.hpp>

#include <cstddef>
#include <string>

namespace cli {

/// The rows and columns of a text, with `scale` pixels per point of the font.
struct text_extent {
  std::size_t rows = 0, columns = 0;
};
[[nodiscard]] text_extent extent_of(const std::string& text, std::size_t scale);

/// Draws text with its upper left corner at a row and a column, clipped to the image. Bytes that are not printable
/// ASCII become question marks.
void draw_text(gonio::image& canvas, std::size_t row, std::size_t column, std::string text, std::size_t scale,
               const gonio::rgb& colour);

}  // namespace cli
