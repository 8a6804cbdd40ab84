#pragma once
/// A small database for tests: smooth synthetic materials over any cells.

#include <gonio/basis/learn_pca.hpp>
#include <gonio/table/material_rows.hpp>
#include <gonio/table/material_set.hpp>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

/// A grid of few cells.
inline const gonio::valid_cells& small_cells() {
  static const gonio::valid_cells cells(gonio::grid({10, 7, 9}));
  return cells;
}

/// Diffuse plus a lobe in theta_h that grows towards grazing; colours, widths and heights at random.
inline gonio::material_set synthetic_materials(const gonio::valid_cells& cells, std::size_t count, unsigned seed = 7) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform;
  gonio::material_set set{cells, {}, gonio::cell_matrix(cells.size(), 3 * count)};
  for (std::size_t m = 0; m < count; ++m) {
    set.names.push_back("material-" + std::to_string(m));
    const double width = 0.05 + 0.4 * uniform(generator), peak = std::exp(4 * uniform(generator) - 1);
    const double colour[3] = {uniform(generator), uniform(generator), uniform(generator)};
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
      const auto angles = cells.angles(cell);
      const double lobe = peak * std::exp(-std::pow(angles.theta_h / width, 2)) * (1 + std::pow(angles.theta_d, 5));
      for (std::size_t c = 0; c < 3; ++c) set.values(cell, 3 * m + c) = static_cast<float>(0.3 * colour[c] + lobe);
    }
  }
  return set;
}

/// The columns of such materials as those of others at some wavelengths, which must divide them.
inline gonio::material_rows at_wavelengths(gonio::material_set set, std::vector<double> wavelengths) {
  gonio::material_rows rows = gonio::rows_of(std::move(set));
  const auto columns = static_cast<std::size_t>(rows.columns());
  rows.names.clear();
  for (std::size_t m = 0; m < columns / wavelengths.size(); ++m) rows.names.push_back("spectra-" + std::to_string(m));
  rows.wavelengths = std::move(wavelengths);
  return rows;
}

/// A prior learned from such materials.
inline gonio::log_relative_pca learn(gonio::material_set set, std::size_t components,
                                     gonio::thread_count threads = {}) {
  const auto metric = gonio::log_relative::to_median_of(set, threads);
  return gonio::learn_pca(std::move(set), metric, components, threads);
}
