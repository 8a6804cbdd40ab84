#pragma once
/// Bodies of estimate/solve_rows.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/estimate/solve_rows.hpp>

#include <vector>

namespace gonio {

GONIO_INLINE solution solve_rows(const tikhonov& solver, const row_source& rows, const located_samples& mapped,
                                 thread_count threads) {
  if (!mapped.weighs_channels_apart())
    return solver.solve(least_squares_problem(rows, mapped.values, mapped.weights_of(0), threads));
  std::vector<solution> found;
  for (Eigen::Index c = 0; c < mapped.values.cols(); ++c)
    found.push_back(solver.solve(least_squares_problem(rows, mapped.values.col(c), mapped.weights_of(c), threads)));
  return concatenate_columns(found);
}

}  // namespace gonio
