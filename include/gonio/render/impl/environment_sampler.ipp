#pragma once
/// Bodies of render/environment_sampler.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/render/environment_sampler.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace gonio::render {

GONIO_INLINE environment_sampler::environment_sampler(environment_map map) : map_(std::move(map)) {
  reached_.reserve(map_.rows() * map_.columns() + 1);
  double sum = 0.0;
  for (std::size_t row = 0; row < map_.rows(); ++row)
    for (std::size_t column = 0; column < map_.columns(); ++column) {
      reached_.push_back(sum);
      sum += luminance(map_.irradiance(row, column));
    }
  reached_.push_back(sum);
}

}  // namespace gonio::render
