#pragma once
/// Bodies of io/table_npy.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/npy.hpp>
#include <gonio/io/table_npy.hpp>
#include <gonio/table/brdf_table.hpp>

#include <filesystem>

namespace gonio::io {

GONIO_INLINE void write_table_npy(const std::filesystem::path& path, const brdf_table& table) {
  const grid& cells = table.cells().grid();
  const auto [theta_h, theta_d, phi_d] = cells.extents();
  const auto wide = [](int extent) { return static_cast<std::size_t>(extent); };
  xt::xtensor<float, 4> array({wide(theta_h), wide(theta_d), wide(phi_d), std::size_t{3}});
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    const rgb value = table.at(table.cells().representative(cell));
    for (std::size_t channel = 0; channel < 3; ++channel)
      array.data()[3 * cell + channel] = static_cast<float>(value[channel]);
  }
  write_npy(path, array);
}

}  // namespace gonio::io
