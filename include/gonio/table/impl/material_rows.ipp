#pragma once
/// Bodies of table/material_rows.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/table/material_rows.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE material_rows rows_of(material_set materials) {
  require_complete(materials);
  const auto held = std::make_shared<const cell_matrix>(std::move(materials.values));
  return {std::move(materials.cells), std::move(materials.names),
          [held](block range, cell_rows out) { out = held->middleRows(range.begin, range.size()); }};
}

GONIO_INLINE material_rows subset(const material_rows& materials, const std::vector<Eigen::Index>& chosen) {
  const Eigen::Index channels = materials.channels(), columns = materials.columns();
  material_rows some{materials.cells,
                     {},
                     [read = materials.read, channels, columns, chosen](block range, cell_rows out) {
                       cell_matrix all(range.size(), columns);
                       read(range, all);
                       for (Eigen::Index i = 0; i < std::ssize(chosen); ++i)
                         out.middleCols(channels * i, channels) = all.middleCols(channels * chosen[i], channels);
                     },
                     materials.wavelengths};
  for (const Eigen::Index material : chosen) {
    if (material < 0 || material >= std::ssize(materials.names))
      refuse({"there is no material number ", material, " among ", materials.names.size()});
    some.names.push_back(materials.names[static_cast<std::size_t>(material)]);
  }
  return some;
}

}  // namespace gonio
