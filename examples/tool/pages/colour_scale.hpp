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

/// Colours from 0 to 1, and the numbers at some of them.
struct colour_scale {
  std::function<gonio::rgb(double)> colour;
  std::vector<std::pair<double, std::string>> numbers;
};

/// The smallest number of columns with room for the numbers of a scale.
inline constexpr std::size_t smallest_with_scale = 64;
/// Returns the scale's rows for an image with a number of columns.
[[nodiscard]] std::size_t rows_of_scale(std::size_t columns) noexcept;
/// Returns the rows of an image with a scale below it; `rows` if there is no room for a scale.
[[nodiscard]] std::size_t rows_with_scale(std::size_t rows, std::size_t columns) noexcept;
/// Draws a scale over the lowest rows of an image.
void draw_scale(gonio::image& image, const colour_scale& scale);

}  // namespace cli
