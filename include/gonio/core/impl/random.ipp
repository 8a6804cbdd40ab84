#pragma once
/// Bodies of core/random.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/random.hpp>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE std::vector<Eigen::Index> random_choice(Eigen::Index all, Eigen::Index count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<Eigen::Index> chosen(all);
  std::iota(chosen.begin(), chosen.end(), Eigen::Index{0});
  count = std::min(count, all);
  // The first steps of a Fisher-Yates shuffle.
  for (Eigen::Index i = 0; i < count; ++i) {
    std::uniform_int_distribution<Eigen::Index> rest(i, all - 1);
    std::swap(chosen[i], chosen[rest(generator)]);
  }
  chosen.resize(count);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace gonio
