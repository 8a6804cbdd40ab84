#pragma once
/// The only interface between the library's tables and xtensor: zero-copy views, and dense arrays for export.

#include <gonio/core/arrays.hpp>
#include <gonio/table/brdf_table.hpp>

#if __has_include(<xtensor/containers/xadapt.hpp>)
#include <xtensor/containers/xadapt.hpp>
#else
#include <xtensor/xadapt.hpp>
#endif

#include <array>
#include <limits>

namespace gonio {

/// Returns a view of shape (cells, 3) on a table's values; the table must outlive it.
[[nodiscard]] inline auto tensor_view(brdf_table& table) {
  const std::array<std::size_t, 2> shape{table.values().size() / 3, 3};
  return xt::adapt(table.values().data(), table.values().size(), xt::no_ownership(), shape);
}

[[nodiscard]] inline auto tensor_view(const brdf_table& table) {
  const std::array<std::size_t, 2> shape{table.values().size() / 3, 3};
  return xt::adapt(table.values().data(), table.values().size(), xt::no_ownership(), shape);
}

/// Returns a copy of shape (theta_h, theta_d, phi_d, 3), with NaN in cells that are not valid.
[[nodiscard]] xt::xtensor<float, 4> dense_tensor(const brdf_table& table);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/tensor_view.ipp>
#endif
