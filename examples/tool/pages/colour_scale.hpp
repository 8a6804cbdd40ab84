#pragma once
/// The legend of an image's colours: a strip with numbers.

#include <gonio/core/rgb.hpp>
#include <gonio/table/image.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace cli {

/// The colours of a scale that runs from 0 to 1, and the numbers written at some points of it.
struct colour_scale {
  std::function<gonio::rgb(double)> colour;
  std::vector<std::pair<double, std::string>> numbers;
};

/// Returns the scale of CIELAB differences from 0 to 20 (`render::difference_colour`).
[[nodiscard]] colour_scale delta_e_scale();
/// Returns the scale of factors from a half to 2 (`render::diverging_colour`).
[[nodiscard]] colour_scale factor_scale();

/// The smallest number of columns with room for the numbers of a scale.
inline constexpr std::size_t smallest_with_scale = 64;
/// Returns the number of rows of a scale that has `columns` columns.
[[nodiscard]] std::size_t rows_of_scale(std::size_t columns) noexcept;
/// Returns the rows of an image with a scale below it; `rows` if there is no room for a scale.
[[nodiscard]] std::size_t rows_with_scale(std::size_t rows, std::size_t columns) noexcept;
/// Draws a scale over the lowest rows of an image. Omits numbers that have no room.
void draw_scale(gonio::image& image, const colour_scale& scale);

}  // namespace cli
