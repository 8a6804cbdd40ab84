#pragma once
/// Bodies of render/sampled_sphere.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/core/sampled_direction.hpp>
#include <gonio/render/environment_sampler.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/lighting.hpp>
#include <gonio/render/sampled_sphere.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>

namespace gonio::render {

GONIO_INLINE double white_sphere_luminance(const environment_map& map) {
  double sum = 0.0;
  for (std::size_t row = 0; row < map.rows(); ++row)
    for (std::size_t column = 0; column < map.columns(); ++column) {
      const double cosine = map.towards(row, column).z();
      const double phase = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) +
                           (std::numbers::pi - std::acos(std::clamp(cosine, -1.0, 1.0))) * cosine;
      sum += luminance(map.irradiance(row, column)) * phase;
    }
  return sum * (2.0 / 3.0) * std::numbers::inv_pi * std::numbers::inv_pi;
}

}  // namespace gonio::render

namespace gonio::render::detail {

GONIO_INLINE even_numbers::even_numbers(Eigen::Index count, std::mt19937_64& generator)
    : count_(static_cast<double>(count)) {
  for (double* first : {&first_.x, &first_.y, &first_.u, &first_.v}) *first = uniform_number(generator);
}

}  // namespace gonio::render::detail
