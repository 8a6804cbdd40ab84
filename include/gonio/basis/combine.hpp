#pragma once
/// Combines a basis' functions at all of its cells at once.

#include <gonio/basis/basis.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/table/upsample.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <concepts>

namespace gonio {

/// A computed basis that evaluates a combination of its functions, given by size() x 3 weights, at all of its cells at
/// once, in float and without the offset. A fit can then be tabulated without a row for each cell.
template <class Basis>
concept combining_basis = computed_basis<Basis> && requires(const Basis& functions, const Eigen::MatrixXd& weights) {
  { functions.combination(weights, thread_count()) } -> std::same_as<cell_fields<3>>;
};

/// A basis that `combine` accepts.
template <class Basis>
concept combinable_basis = tabulated_basis<Basis> || combining_basis<Basis>;

/// Returns a combination of a basis' functions at all of its cells, in float and without the offset.
template <combinable_basis Basis>
[[nodiscard]] cell_fields<3> combine(const Basis& functions, const Eigen::MatrixXd& weights,
                                     thread_count threads = {}) {
  if constexpr (combining_basis<Basis>) {
    return functions.combination(weights, threads);
  } else {
    constexpr Eigen::Index ahead = 32;  // number of rows to prefetch
    const three_columns columns(weights);
    cell_fields<3> field(3, functions.cells().size());
    for_each_index(
        field.cols(), 4096,
        [&](Eigen::Index cell) {
          prefetch(functions.row(std::min(cell + ahead, field.cols() - 1)).data(), functions.size());
          std::ranges::copy(columns.dot_each(functions.row(cell).data()), &field(0, cell));
        },
        threads);
    return field;
  }
}

}  // namespace gonio
