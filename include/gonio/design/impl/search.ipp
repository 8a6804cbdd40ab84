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

GONIO_INLINE std::vector<std::size_t> all_but(std::vector<std::size_t> candidates, std::size_t position) {
  candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(position));
  return candidates;
}

}  // namespace gonio::design::detail
