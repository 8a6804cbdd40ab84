#pragma once
/// Bodies of core/parallel.hpp.

#include <gonio/core/assertion.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace gonio {

GONIO_INLINE unsigned thread_count::resolve() const noexcept {
  if (value != 0) return value;
  static const unsigned processors =
      std::max(1u, std::thread::hardware_concurrency());  // hardware_concurrency reads a file on Linux
  return processors;
}

namespace detail {

/// Joins the started threads on destruction, also if starting another one has thrown. (std::jthread costs more to
/// compile.)
struct thread_team {
  std::vector<std::thread> members;

  ~thread_team() {
    for (std::thread& member : members) member.join();
  }
};

}  // namespace detail

GONIO_INLINE void detail::run_blocks(Eigen::Index count, Eigen::Index block_size, block_body body,
                                     thread_count threads) {
  GONIO_ASSERT(block_size > 0);
  // Run the blocks in order if one thread is enough.
  const Eigen::Index blocks = (count + block_size - 1) / block_size;
  const auto block_at = [&](Eigen::Index b) { return block{b * block_size, std::min(count, (b + 1) * block_size)}; };
  const Eigen::Index workers = std::min<Eigen::Index>(threads.resolve(), blocks);
  if (workers <= 1) {
    for (Eigen::Index b = 0; b < blocks; ++b) body(block_at(b));
    return;
  }

  // Let each worker take the next block until none is left; keep the exception of the first block that throws.
  std::atomic<Eigen::Index> next{0};
  std::mutex failure_mutex;
  std::exception_ptr failure;
  Eigen::Index failed_block = blocks;
  const auto work = [&] {
    for (Eigen::Index b = next++; b < blocks; b = next++) {
      try {
        body(block_at(b));
      } catch (...) {
        const std::scoped_lock lock(failure_mutex);
        if (b < failed_block) {
          failed_block = b;
          failure = std::current_exception();
        }
        next = blocks;
      }
    }
  };
  // Start the other workers, work in this thread too, and wait for all workers.
  {
    detail::thread_team team;
    for (Eigen::Index w = 1; w < workers; ++w) team.members.emplace_back(work);
    work();
  }
  // Report a failure to the caller.
  if (failure) std::rethrow_exception(failure);
}

}  // namespace gonio
