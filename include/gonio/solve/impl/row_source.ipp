#pragma once
/// Bodies of solve/row_source.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <memory>
#include <utility>

namespace gonio {

GONIO_INLINE row_block columns_of_block(row_block all, Eigen::Index first, Eigen::Index count) {
  const Eigen::OuterStride<> stride(all.outerStride());
  return Eigen::Map<row_matrix, 0, Eigen::OuterStride<>>(all.data() + first, all.rows(), count, stride);
}

GONIO_INLINE row_source rows_of(row_matrix matrix) {
  const auto shared = std::make_shared<const row_matrix>(std::move(matrix));
  return {shared->rows(), shared->cols(), [shared](block range, row_block out) {
            for (Eigen::Index i = range.begin; i < range.end; ++i)
              std::copy_n(shared->data() + i * shared->cols(), shared->cols(),
                          out.data() + (i - range.begin) * out.outerStride());
          }};
}

}  // namespace gonio
