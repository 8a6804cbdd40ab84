#pragma once
/// Bodies of table/spectral_table.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/wavelengths.hpp>
#include <gonio/table/spectral_table.hpp>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE spectral_table::spectral_table(valid_cells cells, std::vector<double> wavelengths)
    : cells_(std::move(cells)), wavelengths_(std::move(wavelengths)) {
  require_wavelengths(wavelengths_);
  values_ = cell_matrix::Zero(cells_.size(), std::ssize(wavelengths_));
}

GONIO_INLINE spectral_table::spectral_table(valid_cells cells, std::vector<double> wavelengths, cell_matrix values)
    : cells_(std::move(cells)), wavelengths_(std::move(wavelengths)), values_(std::move(values)) {
  require_wavelengths(wavelengths_);
  if (values_.rows() != cells_.size() || values_.cols() != std::ssize(wavelengths_))
    refuse({"a spectral table over ", cells_.size(), " cells needs ", wavelengths_.size(), " values a cell, got ",
            values_.rows(), " x ", values_.cols()});
}

GONIO_INLINE Eigen::ArrayXf spectral_table::at(const location& at) const {
  Eigen::ArrayXf spectrum(bands());
  for (Eigen::Index band = 0; band < bands(); ++band) {
    double sum = 0.0;
    for (int corner = 0; corner < at.count; ++corner)
      sum += at.weight[corner] * double{values_(Eigen::Index{at.cell[corner]}, band)};
    spectrum[band] = static_cast<float>(sum);
  }
  return spectrum;
}

GONIO_INLINE brdf_table spectral_table::at_wavelength(Eigen::Index band) const {
  brdf_table table(cells_);
  for (Eigen::Index cell = 0; cell < cells_.size(); ++cell) table.set(cell, rgb::Constant(double{values_(cell, band)}));
  return table;
}

GONIO_INLINE brdf_table spectral_table::colours(illuminant light, thread_count threads) const {
  if (bands() == 1) return at_wavelength(0);
  const spectral_colour colour(wavelengths_, light);
  brdf_table table(cells_);
  for_each_index(
      cells_.size(), 4096, [&](Eigen::Index cell) { table.set(cell, colour(at(cell))); }, threads);
  return table;
}

GONIO_INLINE spectral_table tabulate_by_threes(const valid_cells& cells, std::vector<double> wavelengths,
                                               const std::function<brdf_table(Eigen::Index first)>& three) {
  spectral_table table(cells, std::move(wavelengths));
  for (Eigen::Index first = 0; first < table.bands(); first += 3) {
    const brdf_table some = three(first);
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell)
      for (Eigen::Index band = first; band < std::min(first + 3, table.bands()); ++band)
        table.values()(cell, band) = some.values()[3 * cell + band - first];
  }
  return table;
}

}  // namespace gonio
