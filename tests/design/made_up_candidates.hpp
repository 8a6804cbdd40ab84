#pragma once
/// Candidates on a grid of few cells, for the tests of this folder.

#include "../made_up_materials.hpp"
#include <gonio/design/cell_candidates.hpp>

inline const gonio::log_relative_pca& candidate_basis() {
  static const gonio::log_relative_pca basis = learn(made_up_materials(small_cells(), 12), 100);
  return basis;
}

inline gonio::design::cell_candidates made_up_candidates(
    const gonio::design::expected_error_options& options = {.eta = 0.5}, gonio::thread_count threads = {},
    std::span<const double> own_etas = {}) {
  return {candidate_basis(), gonio::design::expected_error(candidate_basis(), options), {}, threads, own_etas};
}
