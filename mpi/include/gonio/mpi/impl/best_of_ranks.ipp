#pragma once
/// Bodies of mpi/best_of_ranks.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/mpi/best_of_ranks.hpp>
#include <gonio/mpi/ranks.hpp>

namespace gonio::mpi {

GONIO_INLINE valued_candidate best_of_ranks(const ranks& ranks, valued_candidate own) {
  const auto is_better = [](const valued_candidate& one, const valued_candidate& other) {
    return one.value < other.value || (one.value == other.value && one.number < other.number);
  };
  for (const auto& bytes : ranks.gather(bytes_of(own))) {
    const auto other = number_of<valued_candidate>(bytes);
    if (is_better(other, own)) own = other;
  }
  return number_of<valued_candidate>(ranks.broadcast(bytes_of(own)));
}

}  // namespace gonio::mpi
