#include "cli/colour_scale.hpp"

#include "cli/image_text.hpp"
#include <gonio/render/image.hpp>

#include <algorithm>

namespace cli {

namespace {

/// Pixels of a point of the font.
std::size_t unit_of(std::size_t columns) noexcept { return std::max<std::size_t>(columns / 200, 1); }

}  // namespace

std::size_t rows_of_scale(std::size_t columns) noexcept { return 16 * unit_of(columns); }

void draw_scale(gonio::image& image, const colour_scale& scale) {
  const std::size_t columns = image.shape(1), unit = unit_of(columns);
  const std::size_t top = image.shape(0) - rows_of_scale(columns);
  for (std::size_t row = top; row < image.shape(0); ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const bool is_bar = row < top + 4 * unit;
      const double share = static_cast<double>(column) / static_cast<double>(columns - 1);
      gonio::set_pixel(image, row, column, is_bar ? scale.colour(share) : gonio::rgb(gonio::rgb::Zero()));
    }
  for (const auto& [share, text] : scale.numbers) {
    const auto middle = static_cast<std::size_t>(share * static_cast<double>(columns));
    const std::size_t width = extent_of(text, unit).columns;
    const std::size_t left = std::min(std::max(middle, width / 2) - width / 2, columns - width);
    draw_text(image, top + 6 * unit, left, text, unit, gonio::rgb::Constant(0.6));
  }
}

gonio::image with_scale(const gonio::image& image, const colour_scale& scale) {
  if (image.shape(1) < smallest_with_scale) return image;
  const std::size_t gap = unit_of(image.shape(1));
  gonio::image larger = gonio::uniform_image(image.shape(0) + 2 * gap + rows_of_scale(image.shape(1)), image.shape(1));
  gonio::render::paste(larger, image, 0, 0);
  draw_scale(larger, scale);
  return larger;
}

}  // namespace cli
