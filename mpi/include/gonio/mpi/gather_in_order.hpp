#pragma once
/// Gathers parts of a job at rank 0 in order, such as the bands of a file. Any rank can compute any part.

#include <gonio/core/parallel.hpp>
#include <gonio/mpi/ranks.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

namespace gonio::mpi {

/// Calls `compute(i)` once for each i of a range: rank r of n computes begin + r, begin + r + n, ... Rank 0 calls
/// `take(i, bytes)` with the results in order. Each rank has at most three parts in memory: the one it computes, and
/// two that rank 0 has not yet received. Sends one message for each part of another rank, and two for each rank. If
/// either function throws, all ranks throw, as with `ranks::together`; parts taken before stay taken.
void gather_in_order(const ranks& ranks, block range,
                     const std::function<std::vector<std::byte>(Eigen::Index)>& compute,
                     const std::function<void(Eigen::Index, std::vector<std::byte>)>& take);

}  // namespace gonio::mpi

#if !defined(GONIO_COMPILED)
#include <gonio/mpi/impl/gather_in_order.ipp>
#endif
