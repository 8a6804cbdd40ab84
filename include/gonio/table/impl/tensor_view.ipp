#pragma once
/// Bodies of table/tensor_view.hpp.

#include <gonio/core/arrays.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/tensor_view.hpp>

#include <array>
#include <limits>

namespace gonio {

GONIO_INLINE xt::xtensor<float, 4> dense_tensor(const brdf_table& table) {
  const auto [theta_h, theta_d, phi_d] = table.cells().grid().extents();
  const std::array<std::size_t, 4> shape{static_cast<std::size_t>(theta_h), static_cast<std::size_t>(theta_d),
                                         static_cast<std::size_t>(phi_d), 3};
  xt::xtensor<float, 4> dense(shape, std::numeric_limits<float>::quiet_NaN());
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
    std::copy_n(table.values().data() + 3 * cell, 3, dense.data() + 3 * table.cells().linear(cell));
  return dense;
}

}  // namespace gonio
