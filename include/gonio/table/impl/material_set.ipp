#pragma once
/// Bodies of table/material_set.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/domain.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <iterator>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE Eigen::Index material_set::find(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) refuse({"there is no material named '", name, "'"});
  return found - names.begin();
}

GONIO_INLINE brdf_table material_set::table(Eigen::Index material) const {
  brdf_table result(cells);
  const Eigen::Index column = 3 * material;
  Eigen::Map<cell_matrix>(result.values().data(), values.rows(), 3) = values.middleCols(column, 3);
  return result;
}

GONIO_INLINE material_set material_set::subset(const std::vector<Eigen::Index>& positions) const {
  material_set some{cells, {}, cell_matrix(values.rows(), 3 * std::ssize(positions))};
  for (Eigen::Index i = 0; i < std::ssize(positions); ++i) {
    const Eigen::Index from = positions[i];
    if (from < 0 || from >= std::ssize(names)) refuse({"there is no material ", from, " among ", names.size()});
    some.names.push_back(names[from]);
    some.values.middleCols(3 * i, 3) = values.middleCols(3 * from, 3);
  }
  return some;
}

}  // namespace gonio
