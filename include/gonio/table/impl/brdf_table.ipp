#pragma once
/// Bodies of table/brdf_table.hpp.

#include <gonio/core/brdf.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/location.hpp>

#include <span>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE brdf_table::brdf_table(valid_cells cells, const std::vector<float>& values)
    : cells_(std::move(cells)), values_(values.begin(), values.end()) {
  if (std::ssize(values_) != 3 * cells_.size())
    refuse({"a table over ", cells_.size(), " cells needs 3 values a cell, got ", values_.size()});
}

GONIO_INLINE brdf_table resample(const brdf_table& table, const valid_cells& cells, thread_count threads) {
  if (cells == table.cells()) return table;
  brdf_table result = brdf_table::uninitialised(cells);
  for_each_index(
      cells.size(), 4096,
      [&](Eigen::Index cell) { result.set(cell, table.at(locate(table.cells(), cells.angles(cell)))); }, threads);
  return result;
}

}  // namespace gonio
