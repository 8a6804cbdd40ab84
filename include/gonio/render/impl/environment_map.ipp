#pragma once
/// Bodies of render/environment_map.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/random.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/lighting.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace gonio::render {

GONIO_INLINE environment_map::environment_map(gonio::image latitude_longitude) : image_(std::move(latitude_longitude)) {
  check_shape();
  check_values();
  row_solid_angles_.reserve(rows());
  const double step = std::numbers::pi / static_cast<double>(rows());
  for (std::size_t row = 0; row < rows(); ++row) {
    // Compute cos a - cos b as a product, which avoids cancellation at the poles. A pixel is as wide as it is high.
    const double middle = step * (static_cast<double>(row) + 0.5);
    row_solid_angles_.push_back(step * 2.0 * std::sin(middle) * std::sin(0.5 * step));
  }
}

GONIO_INLINE void environment_map::check_shape() const {
  if (rows() == 0 || columns() != 2 * rows() || image_.shape(2) != 3)
    refuse("an environment map has the shape (" + std::to_string(rows()) + ", " + std::to_string(columns()) + ", " +
           std::to_string(image_.shape(2)) + "), expected (n, 2 n, 3)");
}

GONIO_INLINE void environment_map::check_values() const {
  const float* end = image_.data() + image_.size();
  const float* bad = std::find_if(image_.data(), end, [](float v) { return !(std::isfinite(v) && v >= 0.0f); });
  if (bad != end) {
    const auto at = (bad - image_.data()) / 3;
    refuse("pixel (row " + std::to_string(at / columns()) + ", column " + std::to_string(at % columns()) +
           ") of an environment map is " + std::to_string(*bad) + ": radiance must be finite and must not be negative");
  }
  if (std::all_of(image_.data(), end, [](float v) { return v == 0.0f; }))
    refuse("an environment map is black everywhere: there must be some light");
}

GONIO_INLINE directional_lighting all_lights(const environment_map& map) {
  std::vector<directional_light> lights;
  for (std::size_t row = 0; row < map.rows(); ++row)
    for (std::size_t column = 0; column < map.columns(); ++column) {
      const rgb irradiance = map.irradiance(row, column);
      if ((irradiance > 0.0).any()) lights.push_back({map.towards(row, column), irradiance});
    }
  return directional_lighting(std::move(lights));
}

}  // namespace gonio::render

namespace gonio::render::detail {

GONIO_INLINE std::vector<double> stratified_draws(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<double> draws;
  draws.reserve(count);
  for (std::size_t i = 0; i < count; ++i) draws.push_back(static_cast<double>(i) + uniform_number(generator));
  return draws;
}

}  // namespace gonio::render::detail

namespace gonio::render {

GONIO_INLINE directional_lighting important_lights(const environment_map& map, std::size_t count, std::uint64_t seed) {
  if (count == 0) refuse("cannot represent an environment map by 0 lights: at least one is needed");
  double total = 0.0;
  detail::for_each_along_hilbert_curve(map.rows(), map.columns(), [&](std::size_t row, std::size_t column) {
    total += luminance(map.irradiance(row, column));
  });
  const std::vector<double> draws = detail::stratified_draws(count, seed);

  // Walk along the curve. Each pixel covers an interval as long as its expected number of draws, and gets the draws in
  // this interval.
  std::vector<directional_light> lights;
  auto next = draws.begin();
  double walked = 0.0;
  detail::for_each_along_hilbert_curve(map.rows(), map.columns(), [&](std::size_t row, std::size_t column) {
    const rgb irradiance = map.irradiance(row, column);
    const double expected = luminance(irradiance) * (static_cast<double>(count) / total);
    walked += expected;
    const auto first = next;
    while (next != draws.end() && *next < walked) ++next;
    if (next != first)
      lights.push_back({map.towards(row, column), irradiance * (static_cast<double>(next - first) / expected)});
  });
  return directional_lighting(std::move(lights));
}

}  // namespace gonio::render
