#pragma once
/// Bodies of solve/row_source.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <utility>

namespace gonio {

GONIO_INLINE row_source rows_of(row_matrix matrix) {
  const auto shared = std::make_shared<const row_matrix>(std::move(matrix));
  return {shared->rows(), shared->cols(), [shared](block range, row_block out) {
            out = shared->middleRows(static_cast<Eigen::Index>(range.begin), static_cast<Eigen::Index>(range.size()));
          }};
}

}  // namespace gonio
