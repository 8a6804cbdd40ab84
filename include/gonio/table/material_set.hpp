#pragma once
/// Tables of several materials over the same cells, as one matrix.

#include <gonio/table/brdf_table.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <iterator>
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

  /// A copy of some of the materials, by their positions. Throws gonio::error for a position that there is not.
  [[nodiscard]] material_set subset(const std::vector<std::size_t>& positions) const {
    material_set some{cells, {}, cell_matrix(values.rows(), 3 * std::ssize(positions))};
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const std::size_t from = positions[i];
      if (from >= names.size())
        throw error("there is no material " + std::to_string(from) + " among " + std::to_string(names.size()));
      some.names.push_back(names[from]);
      some.values.middleCols(static_cast<Eigen::Index>(3 * i), 3) =
          values.middleCols(static_cast<Eigen::Index>(3 * from), 3);
    }
    return some;
  }
};

/// Throws gonio::error unless there is a material, with three columns each and a row for each cell.
inline void require_complete(const material_set& materials) {
  if (materials.names.empty() || materials.values.cols() != static_cast<Eigen::Index>(3 * materials.names.size()) ||
      materials.values.rows() != static_cast<Eigen::Index>(materials.cells.size()))
    throw error("a basis needs at least one material, with three columns each over " +
                std::to_string(materials.cells.size()) + " cells");
}

/// Throws gonio::error naming the first material that is not finite at a cell.
inline void require_finite(const material_set& materials, std::size_t cell) {
  const auto row = materials.values.row(static_cast<Eigen::Index>(cell));
  if (row.allFinite()) return;
  Eigen::Index column = 0;
  while (std::isfinite(row[column])) ++column;
  throw error("material '" + materials.names[static_cast<std::size_t>(column / 3)] + "' is not finite at cell " +
              std::to_string(cell));
}

/// Replaces each value at a cell by `map` of it. Throws gonio::error naming the first material that is not finite
/// there, before or after: a map may hide an infinity, or overflow.
template <class Map>
void map_cell(material_set& materials, std::size_t cell, Map&& map) {
  require_finite(materials, cell);
  auto row = materials.values.row(static_cast<Eigen::Index>(cell));
  row = row.unaryExpr([&](float value) { return static_cast<float>(map(value)); });
  require_finite(materials, cell);
}

}  // namespace gonio
