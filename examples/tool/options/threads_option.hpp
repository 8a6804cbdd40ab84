#pragma once
/// The number of threads.

#include "command.hpp"
#include <gonio/core/parallel.hpp>

namespace cli {

/// Adds `--threads N`.
inline void add_threads_option(command& to, gonio::thread_count& threads) {
  to.add_option("--threads", threads.value, "Number of threads (default: one per core)").check(check::range(1u, 1024u));
}

}  // namespace cli
