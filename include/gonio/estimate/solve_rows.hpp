#pragma once
/// Ridge regression of samples by functions whose rows at them are known: `basis_equations` without a basis.

#include <gonio/estimate/located_samples.hpp>
#include <gonio/solve/row_source.hpp>
#include <gonio/solve/tikhonov.hpp>

namespace gonio {

/// The weights of k functions, k x channels, of which `rows` are the values at mapped samples: of all channels at once
/// or, where samples count more in one than in another, of one after the other. O(n k^2) for each of these.
[[nodiscard]] solution solve_rows(const tikhonov& solver, const row_source& rows, const located_samples& mapped,
                                  thread_count threads = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/solve_rows.ipp>
#endif
