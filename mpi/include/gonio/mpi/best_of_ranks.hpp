#pragma once
/// The best of the candidates that the ranks evaluated separately.

#include <gonio/mpi/ranks.hpp>

#include <Eigen/Core>

namespace gonio::mpi {

/// A candidate's number and its value; smaller is better.
struct valued_candidate {
  double value = 0.0;
  Eigen::Index number = 0;
};

/// Returns, at every rank, the candidate with the lowest value of all ranks; of equal values, the one with the lowest
/// number. Takes 2 (size() - 1) messages of 16 bytes.
[[nodiscard]] valued_candidate best_of_ranks(const ranks& ranks, valued_candidate own);

}  // namespace gonio::mpi

#if !defined(GONIO_COMPILED)
#include <gonio/mpi/impl/best_of_ranks.ipp>
#endif
