#pragma once
/// Candidates on a grid of few cells, for the tests of this folder.

#include "../synthetic_materials.hpp"
#include <gonio/basis/learn_streamed_pca.hpp>
#include <gonio/design/cell_candidates.hpp>

inline const gonio::log_relative_pca& candidate_basis() {
  static const gonio::log_relative_pca basis = learn(synthetic_materials(small_cells(), 12), 100);
  return basis;
}

/// The same columns, grouped as 9 materials at 4 wavelengths.
inline const gonio::log_relative_pca& spectral_candidate_basis() {
  static const gonio::log_relative_pca basis =
      gonio::learn_streamed_pca(at_wavelengths(synthetic_materials(small_cells(), 12), {400.0, 500.0, 600.0, 700.0}),
                                {.components = 100})
          .prior;
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
