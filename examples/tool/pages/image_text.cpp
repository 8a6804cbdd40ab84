#include "image_text.hpp"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_easy_font.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace cli {

namespace {

/// The vertex layout of stb_easy_font.h.
struct font_vertex {
  float x, y, z;
  std::array<unsigned char, 4> colour;
};

}  // namespace

text_extent extent_of(const std::string& text, std::size_t scale) {
  std::string line = text;
  return {9 * scale, scale * static_cast<std::size_t>(stb_easy_font_width(line.data()))};
}

void draw_text(gonio::image& canvas, std::size_t row, std::size_t column, std::string text, std::size_t scale,
               const gonio::rgb& colour) {
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  std::vector<font_vertex> vertices(4 * 32 * (text.size() + 1));  // about 270 bytes per letter, according to its author
  const int quads = stb_easy_font_print(0.0f, 0.0f, text.data(), nullptr, vertices.data(),
                                        static_cast<int>(vertices.size() * sizeof(font_vertex)));
  const auto pixels = [&](float points) { return scale * static_cast<std::size_t>(std::lround(points)); };
  for (int quad = 0; quad < quads; ++quad) {
    // The corners of an upright rectangle, clockwise from the upper left.
    const font_vertex &from = vertices[4 * quad], &to = vertices[4 * quad + 2];
    for (std::size_t y = row + pixels(from.y); y < std::min(row + pixels(to.y), canvas.shape(0)); ++y)
      for (std::size_t x = column + pixels(from.x); x < std::min(column + pixels(to.x), canvas.shape(1)); ++x)
        gonio::set_pixel(canvas, y, x, colour);
  }
}

}  // namespace cli
