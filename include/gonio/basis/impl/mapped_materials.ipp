#pragma once
/// Bodies of basis/mapped_materials.hpp.

#include <gonio/basis/mapped_materials.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/statistics.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE void detail::require_finite(const cell_matrix& rows, Eigen::Index row, Eigen::Index cell,
                                         const material_rows& materials) {
  if (rows.row(row).allFinite()) return;
  Eigen::Index column = 0;
  while (std::isfinite(rows(row, column))) ++column;
  refuse({"material '", materials.names[column / materials.channels()], "' is not finite at cell ", cell});
}

struct mapped_materials::state {
  material_rows materials;
  log_relative weights;  ///< only its cosine weights are used
  bool known;            ///< true if the reference was known before the first pass
  std::vector<float> reference, mean, variation;

  /// Maps a row of reflectances in place.
  template <class Row>
  void map(Row& row, Eigen::Index cell) const {
    const double reference_here = reference[cell];
    const double weight = weights.cosine_weight(cosines(weights.cells().angles(cell)));
    for (Eigen::Index i = 0; i < row.size(); ++i)
      row[i] = static_cast<float>(log_relative::forward(double{row[i]}, reference_here, weight));
  }

  /// Reads, maps and centres a block of cells.
  void read(block range, bool first, row_block out) {
    cell_matrix held(range.size(), materials.columns());
    materials.read(range, held);
    std::vector<float> values(held.cols());
    for (Eigen::Index i = 0; i < range.size(); ++i) {
      const Eigen::Index cell = range.begin + i;
      detail::require_finite(held, i, cell, materials);
      if (first && !known) {
        std::copy_n(&held(i, 0), held.cols(), values.begin());
        reference[cell] = std::max(median(values), 0.0f);
      }
      auto row = held.row(i);
      map(row, cell);
      if (first) mean[cell] = static_cast<float>(row.template cast<double>().mean());
      row.array() -= mean[cell];
      out.row(i) = row.template cast<double>();
      if (first) variation[cell] = static_cast<float>(out.row(i).squaredNorm());
    }
  }
};

GONIO_INLINE mapped_materials::mapped_materials(material_rows materials, cosine_weighting weighting)
    : mapped_materials(materials,
                       log_relative(materials.cells, std::vector<float>(materials.cells.size()), weighting)) {
  state_->known = false;
}

GONIO_INLINE mapped_materials::mapped_materials(material_rows materials, const log_relative& metric) {
  if (materials.names.empty()) refuse("there is no material to learn from");
  if (!(metric.cells() == materials.cells)) refuse("the materials and their reference must be over the same cells");
  const auto cells = static_cast<std::size_t>(materials.cells.size());
  state_ = std::make_shared<state>(state{std::move(materials),
                                         metric,
                                         true,
                                         {metric.reference().begin(), metric.reference().end()},
                                         std::vector<float>(cells),
                                         std::vector<float>(cells)});
}

GONIO_INLINE row_source mapped_materials::source(bool first) const {
  return {state_->materials.cells.size(), state_->materials.columns(),
          [held = state_, first](block range, row_block out) { held->read(range, first, out); }};
}

GONIO_INLINE const material_rows& mapped_materials::materials() const noexcept { return state_->materials; }
GONIO_INLINE std::span<float> mapped_materials::reference() const noexcept { return state_->reference; }
GONIO_INLINE std::span<float> mapped_materials::mean() const noexcept { return state_->mean; }
GONIO_INLINE std::span<float> mapped_materials::variation() const noexcept { return state_->variation; }

GONIO_INLINE double mapped_materials::total_variation() const noexcept {
  return std::accumulate(state_->variation.begin(), state_->variation.end(), 0.0);
}

GONIO_INLINE log_relative mapped_materials::metric() const {
  return {state_->materials.cells, state_->reference, state_->weights.weighting()};
}

}  // namespace gonio
