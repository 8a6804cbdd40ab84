#pragma once
/// Ridge regression of samples by functions whose rows are given: `basis_equations` without a basis.

#include <gonio/estimate/located_samples.hpp>
#include <gonio/solve/row_source.hpp>
#include <gonio/solve/tikhonov.hpp>

namespace gonio {

/// Returns the weights of k functions, k x channels. `rows` has the functions' values at the n mapped samples. If all
/// channels have the same sample weights, solves once for all channels, otherwise once for each channel. O(n k^2) for
/// each solve.
[[nodiscard]] solution solve_rows(const tikhonov& solver, const row_source& rows, const located_samples& mapped,
                                  thread_count threads = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/solve_rows.ipp>
#endif
