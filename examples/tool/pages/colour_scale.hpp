#pragma once
/// What colours in an image mean, as a strip of all of them with numbers.

#include <gonio/core/rgb.hpp>
#include <gonio/table/image.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace cli {

/// Colours from 0 to 1, and the numbers that stand at some of them.
struct colour_scale {
  std::function<gonio::rgb(double)> colour;
  std::vector<std::pair<double, std::string>> numbers;
};

/// From so many columns on the numbers of a scale have room.
inline constexpr std::size_t smallest_with_scale = 64;
/// The scale's rows for an image of so many columns.
[[nodiscard]] std::size_t rows_of_scale(std::size_t columns) noexcept;
/// The rows of an image of so many with a scale below, or as many as before if it has no room for one.
[[nodiscard]] std::size_t rows_with_scale(std::size_t rows, std::size_t columns) noexcept;
/// Draws a scale over the lowest rows of an image.
void draw_scale(gonio::image& image, const colour_scale& scale);

}  // namespace cli
