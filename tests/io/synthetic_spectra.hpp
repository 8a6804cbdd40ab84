#pragma once
/// Files of spectra for tests.

#include "../synthetic_materials.hpp"
#include <gonio/io/materials/rgl.hpp>
#include <gonio/io/materials/rgl_spectra.hpp>
#include <gonio/table/spectral_table.hpp>

#include <filesystem>
#include <string>
#include <vector>

/// Writes materials `first` to `end` - 1 to a folder, at 400 nm, 500 nm, ...
inline void write_synthetic_spectra(const std::filesystem::path& folder, Eigen::Index first, Eigen::Index end,
                                    Eigen::Index bands) {
  std::filesystem::create_directory(folder);
  const auto set = synthetic_materials(gonio::valid_cells(gonio::grid({18, 12, 18})), 12);
  std::vector<double> wavelengths;
  for (Eigen::Index band = 0; band < bands; ++band) wavelengths.push_back(400.0 + 100.0 * static_cast<double>(band));
  for (Eigen::Index m = first; m < end; ++m) {
    gonio::spectral_table table(set.cells, wavelengths);
    for (Eigen::Index band = 0; band < bands; ++band) table.values().col(band) = set.values.col(3 * m + band % 3);
    const std::string name = "paint-" + std::to_string(m);
    gonio::io::write_rgl(folder / (name + ".bsdf"), gonio::io::tabulate_adaptively(table, 0.0, name));
  }
}
