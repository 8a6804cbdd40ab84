#pragma once
/// Sums over all ranks. The bytes of a sum do not depend on the number of ranks.

#include <gonio/core/parallel.hpp>
#include <gonio/mpi/ranks.hpp>

#include <Eigen/Core>

#include <functional>

namespace gonio::mpi {

/// Returns the groups of a rank. Of n ranks, rank r begins with group r * groups / n, rounded up.
[[nodiscard]] block groups_of(int rank, int ranks, Eigen::Index groups);

/// Returns the sum of `partial(g)` over the groups g from 0 on, at every rank. All partial sums must have one size.
/// Each rank computes the partial sums of its `groups_of`. All are added along one binary tree, whatever the number of
/// ranks: the sum of [b, e) is the sum of [b, m) plus the sum of [m, e), with m - b the largest power of two below e -
/// b. Holds log2(groups) partial sums in memory. Sends a message for each node of the tree whose halves begin at
/// different ranks. For n ranks, these are n - 1 messages if n is a power of two that divides the groups. Sends n - 1
/// more messages with the result. If any rank throws, all throw, as with `ranks::together`.
[[nodiscard]] Eigen::MatrixXd sum_of_groups(const ranks& ranks, Eigen::Index groups,
                                            const std::function<Eigen::MatrixXd(Eigen::Index)>& partial);

}  // namespace gonio::mpi

#if !defined(GONIO_COMPILED)
#include <gonio/mpi/impl/sum_of_groups.ipp>
#endif
