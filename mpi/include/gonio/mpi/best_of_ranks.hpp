#pragma once
/// The best of candidates that the ranks have looked at each for itself.

#include <gonio/mpi/ranks.hpp>

#include <Eigen/Core>

namespace gonio::mpi {

/// A candidate by its number, and what it is worth: less is better.
struct valued_candidate {
  double value = 0.0;
  Eigen::Index number = 0;
};

/// The one of all ranks' candidates with the lowest value, at every rank; of equal ones that with the lowest number.
/// 2 (size() - 1) messages of 16 bytes.
[[nodiscard]] valued_candidate best_of_ranks(const ranks& ranks, valued_candidate own);

}  // namespace gonio::mpi

#if !defined(GONIO_COMPILED)
#include <gonio/mpi/impl/best_of_ranks.ipp>
#endif
