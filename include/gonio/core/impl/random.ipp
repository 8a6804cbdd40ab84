#pragma once
/// Bodies of core/random.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/random.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE std::vector<std::size_t> random_choice(std::size_t all, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<std::size_t> chosen(all);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  count = std::min(count, all);
  // The first steps of a Fisher-Yates shuffle.
  for (std::size_t i = 0; i < count; ++i) {
    std::uniform_int_distribution<std::size_t> rest(i, all - 1);
    std::swap(chosen[i], chosen[rest(generator)]);
  }
  chosen.resize(count);
  std::ranges::sort(chosen);
  return chosen;
}

}  // namespace gonio
