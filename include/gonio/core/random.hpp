#pragma once
/// Random numbers from seeds. `uniform_number` is the same everywhere, since the standard fixes what std::mt19937_64
/// draws; `random_choice` is the same wherever the standard library's uniform_int_distribution is.

#include <Eigen/Core>

#include <cstdint>
#include <random>
#include <vector>

namespace gonio {

/// A number from 0 up to 1, of 53 random bits: all that a double holds.
[[nodiscard]] inline double uniform_number(std::mt19937_64& generator) {
  return static_cast<double>(generator() >> 11) * 0x1p-53;
}

/// `count` different ones of the numbers 0 ... all - 1, each set equally likely, in increasing order; all of them if
/// there are not more. O(all).
[[nodiscard]] std::vector<Eigen::Index> random_choice(Eigen::Index all, Eigen::Index count, std::uint64_t seed);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/random.ipp>
#endif
