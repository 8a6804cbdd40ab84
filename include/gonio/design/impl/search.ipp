#pragma once
/// Bodies of design/search.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/design/capture_geometry.hpp>
#include <gonio/design/search.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace gonio::design::detail {

GONIO_INLINE std::vector<Eigen::Index> without(std::vector<Eigen::Index> candidates, Eigen::Index position) {
  candidates.erase(candidates.begin() + position);
  return candidates;
}

}  // namespace gonio::design::detail
