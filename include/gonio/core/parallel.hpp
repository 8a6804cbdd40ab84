#pragma once
/// Parallel loops over blocks of a range whose results do not depend on the number of threads. The range alone
/// determines the blocks, and partial results are merged in the order of the range.

#include <Eigen/Core>

#include <algorithm>
#include <type_traits>
#include <vector>

namespace gonio {

/// The number of threads that a loop may use; 0 means the number of processor cores.
struct thread_count {
  unsigned value = 0;

  [[nodiscard]] unsigned resolve() const noexcept;
};

/// A half-open range of indices.
struct block {
  Eigen::Index begin = 0;
  Eigen::Index end = 0;

  [[nodiscard]] Eigen::Index size() const noexcept { return end - begin; }
};

namespace detail {

/// A reference to a loop body, without its type. The code for threads and exceptions is then compiled once, not for
/// every body.
struct block_body {
  void* body = nullptr;
  void (*call)(void* body, block range) = nullptr;

  void operator()(block range) const { call(body, range); }
};

void run_blocks(Eigen::Index count, Eigen::Index block_size, block_body body, thread_count threads);

}  // namespace detail

/// Calls `body(block)` once for each block of at most `block_size` indices of [0, count), in any order and
/// concurrently. If a body throws, no new blocks start. After all threads have stopped, the exception of the throwing
/// block with the smallest indices is rethrown.
template <class Body>
void for_each_block(Eigen::Index count, Eigen::Index block_size, Body&& body, thread_count threads = {}) {
  const auto call = [](void* held, block range) { (*static_cast<std::remove_reference_t<Body>*>(held))(range); };
  detail::run_blocks(count, block_size, {const_cast<void*>(static_cast<const void*>(&body)), call}, threads);
}

/// Calls `body(i)` once for each i of [0, count), in blocks of at most `block_size`, as `for_each_block` does.
template <class Body>
void for_each_index(Eigen::Index count, Eigen::Index block_size, Body&& body, thread_count threads = {}) {
  for_each_block(
      count, block_size,
      [&](block range) {
        for (Eigen::Index i = range.begin; i < range.end; ++i) body(i);
      },
      threads);
}

/// Sums over a range. `accumulate(partial, block)` adds a block's contribution to a partial result that starts as a
/// copy of `zero`. The partial results are added with `+=`. The range is divided into at most 16 runs of blocks, each
/// summed in order, so that the result has the same bytes for any number of threads.
template <class Result, class Accumulate>
[[nodiscard]] Result sum_over_blocks(Eigen::Index count, Eigen::Index block_size, const Result& zero,
                                     Accumulate&& accumulate, thread_count threads = {}) {
  constexpr Eigen::Index runs = 16;
  const Eigen::Index blocks = (count + block_size - 1) / block_size;
  const Eigen::Index run_size = std::max<Eigen::Index>(1, (blocks + runs - 1) / runs) * block_size;
  std::vector<Result> partial((count + run_size - 1) / run_size, zero);
  for_each_block(
      count, run_size,
      [&](block run) {
        Result& sum = partial[run.begin / run_size];
        for (Eigen::Index begin = run.begin; begin < run.end; begin += block_size)
          accumulate(sum, block{begin, std::min(run.end, begin + block_size)});
      },
      threads);
  Result total = zero;
  for (const Result& sum : partial) total += sum;
  return total;
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/parallel.ipp>
#endif
