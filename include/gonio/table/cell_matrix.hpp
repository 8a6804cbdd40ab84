#pragma once
/// Values of several functions or materials over the cells of a grid.

#include <Eigen/Core>

namespace gonio {

/// Rows are cells. Columns are observations: red, green and blue of the first material, then of the next.
using cell_matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace gonio
