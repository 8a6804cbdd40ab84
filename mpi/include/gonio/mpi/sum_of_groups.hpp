#pragma once
/// Sums over all ranks whose bytes do not depend on the number of ranks.

#include <gonio/core/parallel.hpp>
#include <gonio/mpi/ranks.hpp>

#include <Eigen/Core>

#include <functional>

namespace gonio::mpi {

/// Returns a rank's groups. The first is r groups / n, rounded up. Rank 0 has group 0.
[[nodiscard]] block groups_of(int rank, int ranks, Eigen::Index groups);

/// Returns the sum of `partial(g)` over the groups g from 0 on, at every rank. All partial sums must have one size.
/// Each rank computes those of its `groups_of`. They are added along one binary tree for any number of ranks: the sum
/// of the groups [b, e) is that of [b, m) plus that of [m, e), with m - b the largest power of two below e - b. Holds
/// log2(groups) partial sums in memory. Sends a sum for each node of the tree whose halves begin at different ranks: n
/// - 1 messages if n is a power of two that divides the groups, and as many again for the result. If any rank throws,
/// all throw, as with `ranks::together`.
[[nodiscard]] Eigen::MatrixXd sum_of_groups(const ranks& ranks, Eigen::Index groups,
                                            const std::function<Eigen::MatrixXd(Eigen::Index)>& partial);

}  // namespace gonio::mpi

#if !defined(GONIO_COMPILED)
#include <gonio/mpi/impl/sum_of_groups.ipp>
#endif
