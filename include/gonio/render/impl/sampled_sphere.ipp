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

#include <array>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace gonio::render::detail {

GONIO_INLINE even_pairs::even_pairs(Eigen::Index count, std::uint64_t seed, std::uint64_t stream)
    : generator_(seed * 0x9E3779B97F4A7C15u + stream), all_(count) {
  for (Eigen::Index kind = 0; kind < kinds; ++kind) {
    const double first_u = next(), first_v = next();
    for (Eigen::Index i = 0; i < count; ++i) {
      const double u = first_u + static_cast<double>(i) / root, v = first_v + static_cast<double>(i) / (root * root);
      all_[i][kind] = {u - std::floor(u), v - std::floor(v)};
    }
    for (Eigen::Index i = count; i > 1; --i)
      std::swap(all_[i - 1][kind], all_[static_cast<Eigen::Index>(next() * static_cast<double>(i))][kind]);
  }
}

}  // namespace gonio::render::detail
