#pragma once
/// Bodies of table/material_rows.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/table/material_rows.hpp>

#include <memory>
#include <utility>

namespace gonio {

GONIO_INLINE material_rows rows_of(material_set materials) {
  require_complete(materials);
  const auto held = std::make_shared<const cell_matrix>(std::move(materials.values));
  return {std::move(materials.cells), std::move(materials.names),
          [held](block range, cell_rows out) { out = held->middleRows(range.begin, range.size()); }};
}

}  // namespace gonio
