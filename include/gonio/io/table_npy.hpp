#pragma once
/// Tables as arrays of numpy: float32 of shape (theta_h, theta_d, phi_d, 3), sr^-1.

#include <gonio/io/npy.hpp>
#include <gonio/table/brdf_table.hpp>

#include <filesystem>

namespace gonio::io {

/// Writes a table for whoever reads arrays. A cell below the horizon has the value of the one above it in theta_h that
/// is not: no hole for an interpolation to fall into. Which cells these are is geometry: see `valid_cells`.
inline void write_table_npy(const std::filesystem::path& path, const brdf_table& table) {
  const grid& cells = table.cells().grid();
  const auto [theta_h, theta_d, phi_d] = cells.extents();
  const auto wide = [](int extent) { return static_cast<std::size_t>(extent); };
  xt::xtensor<float, 4> array({wide(theta_h), wide(theta_d), wide(phi_d), std::size_t{3}});
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const rgb value = table.at(table.cells().representative(cell));
    for (std::size_t channel = 0; channel < 3; ++channel)
      array.data()[3 * cell + channel] = static_cast<float>(value[static_cast<Eigen::Index>(channel)]);
  }
  write_npy(path, array);
}

}  // namespace gonio::io
