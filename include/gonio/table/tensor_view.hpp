#pragma once
/// The one place where the library's tables meet xtensor: zero-copy views, and dense arrays for export.

#include <gonio/table/brdf_table.hpp>

#include <xtensor/xadapt.hpp>
#include <xtensor/xtensor.hpp>

#include <array>
#include <limits>

namespace gonio {

/// A view of shape (cells, 3) on a table's values; the table must outlive it.
[[nodiscard]] inline auto tensor_view(brdf_table& table) {
  const std::array<std::size_t, 2> shape{table.cells().size(), 3};
  return xt::adapt(table.values().data(), table.values().size(), xt::no_ownership(), shape);
}

[[nodiscard]] inline auto tensor_view(const brdf_table& table) {
  const std::array<std::size_t, 2> shape{table.cells().size(), 3};
  return xt::adapt(table.values().data(), table.values().size(), xt::no_ownership(), shape);
}

/// A copy of shape (theta_h, theta_d, phi_d, 3), NaN where a direction is below the horizon.
[[nodiscard]] inline xt::xtensor<float, 4> dense_tensor(const brdf_table& table) {
  const auto [theta_h, theta_d, phi_d] = table.cells().grid().extents();
  const std::array<std::size_t, 4> shape{static_cast<std::size_t>(theta_h), static_cast<std::size_t>(theta_d),
                                         static_cast<std::size_t>(phi_d), 3};
  xt::xtensor<float, 4> dense(shape, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t cell = 0; cell < table.cells().size(); ++cell)
    std::copy_n(table.values().data() + 3 * cell, 3, dense.data() + 3 * table.cells().linear(cell));
  return dense;
}

}  // namespace gonio
