#pragma once
/// The matrix of a least-squares problem, read a block of rows at a time: from an array, from the table of a basis, or
/// by interpolation between the cells of a table. A million rows of 99 numbers need no second copy.

#include <gonio/core/compiled_alignment.hpp>
#include <gonio/core/parallel.hpp>

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <utility>

namespace gonio {

/// A matrix with contiguous rows.
using row_matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The destination of a block of rows: contiguous rows at any distance.
using row_block = Eigen::Ref<row_matrix, 0, Eigen::OuterStride<>>;

/// Returns a view of `count` columns of a block, starting with column `first`.
[[nodiscard]] row_block columns_of_block(row_block all, Eigen::Index first, Eigen::Index count);

/// A matrix of `rows` x `columns` numbers. `read(range, out)` writes the rows of a range into `out`, which has that
/// many rows. `read` is called from several threads at once.
///
/// ```cpp
/// // The powers of 1,000,000 numbers, never stored.
/// gonio::row_source powers{1'000'000, 4, [](gonio::block range, gonio::row_block out) {
///   for (Eigen::Index i = range.begin; i < range.end; ++i)
///     for (int power = 0; power < 4; ++power) out(i - range.begin, power) = std::pow(1e-6 * i, power);
/// }};
/// ```
struct row_source {
  Eigen::Index rows = 0;
  Eigen::Index columns = 0;
  std::function<void(block range, row_block out)> read;
};

/// Returns the source of a matrix in memory.
[[nodiscard]] row_source rows_of(row_matrix matrix);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/row_source.ipp>
#endif
