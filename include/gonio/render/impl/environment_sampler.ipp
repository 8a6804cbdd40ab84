#pragma once
/// Bodies of render/environment_sampler.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/render/environment_sampler.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace gonio::render {

GONIO_INLINE environment_sampler::environment_sampler(environment_map map) : map_(std::move(map)) {
  const std::size_t pixels = map_.rows() * map_.columns();
  order_.reserve(pixels);
  reached_.reserve(pixels + 1);
  double sum = 0.0;
  detail::for_each_along_hilbert_curve(map_.rows(), map_.columns(), [&](std::size_t row, std::size_t column) {
    order_.push_back(static_cast<std::uint32_t>(row * map_.columns() + column));
    reached_.push_back(sum);
    sum += luminance(map_.irradiance(row, column));
  });
  reached_.push_back(sum);
  pdf_per_luminance_ = 1.0 / sum;
  for (std::size_t row = 0; row <= map_.rows(); ++row)
    edges_.push_back(std::cos(static_cast<double>(row) * std::numbers::pi / static_cast<double>(map_.rows())));
  // Store the first position of each step, and one more position to allow for rounding at the end.
  guesses_.reserve(pixels + 1);
  std::size_t position = 0;
  for (std::size_t step = 0; step < pixels; ++step) {
    const double least = static_cast<double>(step) / static_cast<double>(pixels) * (1.0 - 1e-12) * sum;
    while (position + 1 < pixels && reached_[position + 1] <= least) ++position;
    guesses_.push_back(static_cast<std::uint32_t>(position));
  }
  guesses_.push_back(static_cast<std::uint32_t>(pixels - 1));
}

}  // namespace gonio::render
