#pragma once
/// Tables of several materials over the same cells, as one matrix.

#include <gonio/table/brdf_table.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <string>
#include <vector>

namespace gonio {

/// Rows are cells, columns are observations: red, green and blue of the first material, then of the next.
using cell_matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Dense tables of named materials over common cells; `values` has shape (cells, 3 materials), sr^-1.
/// 100 materials on MERL's grid take 1.3 GB.
struct material_set {
  valid_cells cells;
  std::vector<std::string> names;
  cell_matrix values;

  /// Position of a material. Throws gonio::error if there is none of that name.
  [[nodiscard]] std::size_t find(const std::string& name) const {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) throw error("there is no material named '" + name + "'");
    return static_cast<std::size_t>(found - names.begin());
  }

  /// A copy of one material's table.
  [[nodiscard]] brdf_table table(std::size_t material) const {
    brdf_table result(cells);
    const auto column = static_cast<Eigen::Index>(3 * material);
    Eigen::Map<cell_matrix>(result.values().data(), values.rows(), 3) = values.middleCols(column, 3);
    return result;
  }
};

}  // namespace gonio
