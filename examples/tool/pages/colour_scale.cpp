#include "colour_scale.hpp"

#include "image_text.hpp"
#include <gonio/render/false_colour.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace cli {

namespace {

/// Returns the pixels per point of the font.
std::size_t unit_of(std::size_t columns) noexcept { return std::max<std::size_t>(columns / 200, 1); }

}  // namespace

colour_scale delta_e_scale() {
  return {[](double share) { return gonio::render::difference_colour(20.0 * share); },
          {{0.0, "0"}, {0.25, "5"}, {0.5, "10"}, {0.75, "15"}, {1.0, "20+"}}};
}

colour_scale factor_scale() {
  return {[](double share) { return gonio::render::diverging_colour(2.0 * share - 1.0, 1.0); },
          {{0.0, "1/2"}, {0.5, "1"}, {1.0, "2"}}};
}

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
  // Write the numbers at both ends first, then from the left each number that still has room.
  std::vector<std::size_t> order{0};
  if (scale.numbers.size() > 1) order.push_back(scale.numbers.size() - 1);
  for (std::size_t i = 1; i + 1 < scale.numbers.size(); ++i) order.push_back(i);
  std::vector<std::pair<std::size_t, std::size_t>> written;  // first and last column
  for (const std::size_t i : order) {
    const auto& [share, text] = scale.numbers[i];
    const auto middle = static_cast<std::size_t>(share * static_cast<double>(columns));
    const std::size_t width = extent_of(text, unit).columns;
    const std::size_t left = std::min(std::max(middle, width / 2) - width / 2, columns - width);
    const std::size_t right = left + width + 2 * unit;
    if (std::ranges::any_of(written, [&](const auto& other) { return left < other.second && other.first < right; }))
      continue;
    written.emplace_back(left, right);
    draw_text(image, top + 6 * unit, left, text, unit, gonio::rgb::Constant(0.6));
  }
}

}  // namespace cli
