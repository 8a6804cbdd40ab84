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

GONIO_INLINE row_source rows_of(row_matrix matrix) {
  const auto shared = std::make_shared<const row_matrix>(std::move(matrix));
  return {shared->rows(), shared->cols(), [shared](block range, row_block out) {
            for (std::size_t i = range.begin; i < range.end; ++i)
              std::copy_n(shared->data() + static_cast<Eigen::Index>(i) * shared->cols(), shared->cols(),
                          out.data() + static_cast<Eigen::Index>(i - range.begin) * out.outerStride());
          }};
}

}  // namespace gonio
