#pragma once
/// Sums over all ranks whose bytes do not depend on how many ranks there are.

#include <gonio/core/parallel.hpp>
#include <gonio/mpi/ranks.hpp>

#include <Eigen/Core>

#include <functional>

namespace gonio::mpi {

/// Which groups of a number of them are a rank's: r groups / n, rounded up, is the first. Rank 0 has group 0.
[[nodiscard]] block groups_of(int rank, int ranks, Eigen::Index groups);

/// The sum of `partial(g)` over the groups g from 0 on, at every rank; all must have one size. Each rank computes the
/// partial sums of its `groups_of`, and they are added two by two along one binary tree, whatever the number of ranks:
/// the sum of the groups [b, e) is that of [b, m) and that of [m, e), with m - b the largest power of two below e - b.
/// log2(groups) partial sums in memory. A sum is sent for each node of the tree whose halves begin at two ranks: for n
/// ranks, a power of two that divides the groups, n - 1 messages; as many again tell the result to all.
/// Throws in all ranks if any throws, as `ranks::together` does.
[[nodiscard]] Eigen::MatrixXd sum_of_groups(const ranks& ranks, Eigen::Index groups,
                                            const std::function<Eigen::MatrixXd(Eigen::Index)>& partial);

}  // namespace gonio::mpi

#if !defined(GONIO_COMPILED)
#include <gonio/mpi/impl/sum_of_groups.ipp>
#endif
