#pragma once
/// Parts of a job, each of which any rank can compute, and which rank 0 needs in their order: the bands of a file.

#include <gonio/core/parallel.hpp>
#include <gonio/mpi/ranks.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

namespace gonio::mpi {

/// Calls `compute(i)` once for each i of a range: rank r of n those of its begin + r, begin + r + n, ... Rank 0 calls
/// `take(i, bytes)` with what was computed, in order. Each rank has at most three parts in memory: one that it
/// computes, two that rank 0 has not yet received. A message for each part of another rank, and two for each rank.
/// If either throws, it throws in all ranks, as `ranks::together` does; what was taken before stays taken.
void gather_in_order(const ranks& ranks, block range,
                     const std::function<std::vector<std::byte>(Eigen::Index)>& compute,
                     const std::function<void(Eigen::Index, std::vector<std::byte>)>& take);

}  // namespace gonio::mpi

#if !defined(GONIO_COMPILED)
#include <gonio/mpi/impl/gather_in_order.ipp>
#endif
