#pragma once
/// Bodies of estimate/angular_error.hpp.

#include <gonio/basis/pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/estimate/angular_error.hpp>

#include <array>
#include <numbers>
#include <vector>

namespace gonio::detail {

GONIO_INLINE std::array<direction_pair, 8> pairs_with_angular_error(const direction_pair& meant, double angle) {
  std::array<direction_pair, 8> pairs;
  for (Eigen::Index quarter = 0; quarter < 4; ++quarter) {
    const double side = static_cast<double>(quarter) * std::numbers::pi / 2.0;
    pairs[2 * quarter] = {turned_above_horizon(meant.wi, angle, side), meant.wo};
    pairs[2 * quarter + 1] = {meant.wi, turned_above_horizon(meant.wo, angle, side)};
  }
  return pairs;
}

}  // namespace gonio::detail
