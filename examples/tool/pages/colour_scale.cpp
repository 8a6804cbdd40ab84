#include "colour_scale.hpp"

#include "image_text.hpp"

#include <algorithm>

namespace cli {

namespace {

/// Returns the pixels per point of the font.
std::size_t unit_of(std::size_t columns) noexcept { return std::max<std::size_t>(columns / 200, 1); }

}  // namespace

std::size_t rows_of_scale(std::size_t columns) noexcept { return 16 * unit_of(columns); }

std::size_t rows_with_scale(std::size_t rows, std::size_t columns) noexcept {
  return columns < smallest_with_scale ? rows : rows + 2 * unit_of(columns) + rows_of_scale(columns);
}

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

}  // namespace cli
