#pragma once
/// Random numbers from seeds. `uniform_number` is the same on every platform, because the standard defines the numbers
/// of std::mt19937_64. `random_choice` depends on the standard library's uniform_int_distribution.

#include <Eigen/Core>

#include <cstdint>
#include <random>
#include <vector>

namespace gonio {

/// Returns a number in [0, 1) with 53 random bits, the precision of a double.
[[nodiscard]] inline double uniform_number(std::mt19937_64& generator) {
  return static_cast<double>(generator() >> 11) * 0x1p-53;
}

/// Returns `count` different numbers of 0 ... all - 1 in increasing order, each subset equally likely; all numbers if
/// `count` is larger than `all`. O(all).
[[nodiscard]] std::vector<Eigen::Index> random_choice(Eigen::Index all, Eigen::Index count, std::uint64_t seed);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/random.ipp>
#endif
