#pragma once
/// Candidates on a grid of few cells, for the tests of this folder.

#include "../synthetic_materials.hpp"
#include <gonio/design/cell_candidates.hpp>

inline const gonio::log_relative_pca& candidate_basis() {
  static const gonio::log_relative_pca basis = learn(synthetic_materials(small_cells(), 12), 100);
  return basis;
}

inline gonio::design::cell_candidates synthetic_candidates(
    const gonio::design::expected_error_options& options = {.eta = 0.5}, gonio::thread_count threads = {},
    std::span<const double> sample_noise_penalties = {}) {
  return {candidate_basis(),
          gonio::design::expected_error(candidate_basis(), options),
          {},
          threads,
          sample_noise_penalties};
}
