#pragma once
/// Bodies of estimate/mapped_noise.hpp.

#include <gonio/basis/basis.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/estimate/mapped_noise.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace gonio::detail {

GONIO_INLINE std::vector<double> normal_quantiles(int count) {
  std::vector<double> quantiles;
  for (int i = 0; i < count; ++i) {
    const double share = (i + 0.5) / count;
    double low = -10.0, high = 10.0;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = (low + high) / 2.0;
      (0.5 * std::erfc(-middle / std::sqrt(2.0)) < share ? low : high) = middle;
    }
    quantiles.push_back((low + high) / 2.0);
  }
  return quantiles;
}

}  // namespace gonio::detail
