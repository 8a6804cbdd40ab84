#pragma once
/// Bodies of io/materials/table_npy.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/materials/table_npy.hpp>
#include <gonio/table/brdf_table.hpp>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace gonio::io {

namespace detail {

[[nodiscard]] inline xt::xtensor<float, 4> table_as_array(const brdf_table& table) {
  const grid& cells = table.cells().grid();
  if (cells.anchor() != cell_anchor::centre) return table_as_array(resample(table, valid_cells(grid(cells.extents()))));
  const auto [theta_h, theta_d, phi_d] = cells.extents();
  const auto wide = [](int extent) { return static_cast<std::size_t>(extent); };
  xt::xtensor<float, 4> array({wide(theta_h), wide(theta_d), wide(phi_d), std::size_t{3}});
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    const rgb value = table.at(table.cells().representative(cell));
    for (std::size_t channel = 0; channel < 3; ++channel)
      array.data()[3 * cell + channel] = static_cast<float>(value[channel]);
  }
  return array;
}

}  // namespace detail

GONIO_INLINE void write_table_npy(const std::filesystem::path& path, const brdf_table& table) {
  write_npy(path, detail::table_as_array(table));
}

GONIO_INLINE void write_table_npy_halves(const std::filesystem::path& path, const brdf_table& table) {
  write_npy_halves(path, detail::table_as_array(table));
}

GONIO_INLINE brdf_table read_table_npy(std::span<const std::byte> bytes, const std::string& name) {
  const xt::xtensor<float, 4> array = read_npy<float, 4>(bytes, name);
  const auto& shape = array.shape();
  const auto fits = [](std::size_t extent) { return extent >= 1 && extent <= 4096; };
  if (!fits(shape[0]) || !fits(shape[1]) || !fits(shape[2]) || shape[3] != 3)
    refuse({name, ": has shape ", npy_shape_text(shape),
            ", expected (theta_h, theta_d, phi_d, 3) with at most 4096 cells along each axis"});
  const auto extent = [&](std::size_t axis) { return static_cast<int>(shape[axis]); };
  brdf_table table(valid_cells(grid({extent(0), extent(1), extent(2)})));
  const valid_cells& cells = table.cells();
  for (Eigen::Index linear = 0; linear < cells.grid().size(); ++linear) {
    if (!cells.contains(linear)) continue;
    const float* value = array.data() + 3 * linear;
    if (!std::isfinite(value[0]) || !std::isfinite(value[1]) || !std::isfinite(value[2]))
      refuse({name, ": cell ", linear, " has a value that is not finite"});
    table.set(cells.representative(linear), {value[0], value[1], value[2]});
  }
  return table;
}

}  // namespace gonio::io
