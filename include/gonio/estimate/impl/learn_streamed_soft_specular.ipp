#pragma once
/// Bodies of estimate/learn_streamed_soft_specular.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/highlight_contrast.hpp>
#include <gonio/estimate/learn_streamed_soft_specular.hpp>
#include <gonio/metric/log_relative.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace gonio::detail {

/// The median over all materials' columns at each cell, and the materials' contrasts relative to this median.
struct streamed_contrasts {
  std::vector<float> reference;
  Eigen::ArrayXd contrasts;
};

/// Computes medians and contrasts in one pass, with the sums of `cell_contrasts`.
[[nodiscard]] GONIO_INLINE streamed_contrasts contrasts_of(const material_rows& materials,
                                                           const streaming_options& options, const progress& listener) {
  report(listener, "contrasts", 0.0);
  const valid_cells& cells = materials.cells;
  std::vector<float> reference(cells.size());
  const log_relative weights(cells, reference, options.weighting);  // only its cosine weights are used
  const auto add = [&](contrast_sums& sums, block range) {          // also sets the references
    cell_matrix held(range.size(), materials.columns());
    materials.read(range, held);
    std::vector<float> values(held.cols());
    for (Eigen::Index i = 0; i < range.size(); ++i) {
      const Eigen::Index cell = range.begin + i;
      require_finite(held, i, cell, materials);
      std::copy_n(&held(i, 0), held.cols(), values.begin());
      reference[cell] = std::max(median(values), 0.0f);
      Eigen::ArrayXd* mapped = sums.region_of(cells.angles(cell), {});
      if (mapped == nullptr) continue;
      const double weight = weights.cosine_weight(cosines(cells.angles(cell)));
      for (Eigen::Index m = 0; m < mapped->size(); ++m) {
        const Eigen::Array3f value = held.row(i).segment<3>(3 * m).transpose();
        (*mapped)[m] += log_relative::forward(luminance(value.cast<double>()), double{reference[cell]}, weight);
      }
    }
  };
  constexpr Eigen::Index block_size = 1024, read_at_once = 128;
  const contrast_sums sums = sum_over_blocks(
      cells.size(), block_size, contrast_sums(std::ssize(materials.names)),
      [&](contrast_sums& sum, block range) {
        for (Eigen::Index begin = range.begin; begin < range.end; begin += read_at_once)
          add(sum, {begin, std::min(begin + read_at_once, range.end)});
      },
      options.threads);
  return {std::move(reference), sums.contrasts_of_cells()};
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE streamed_soft_specular learn_streamed_soft_specular(const material_rows& materials,
                                                                 const streaming_options& options,
                                                                 std::optional<double> threshold,
                                                                 const progress& listener) {
  if (materials.names.empty()) refuse("there is no material to learn from");
  if (!materials.wavelengths.empty()) refuse("splitting materials into soft and specular needs RGB, not spectra");
  auto [reference, contrasts] = detail::contrasts_of(materials, options, listener);
  const log_relative metric(materials.cells, std::move(reference), options.weighting);
  const parted_by_contrast halves = part_by_contrast(materials.names, contrasts, threshold);
  const streamed_pca soft = learn_streamed_pca(subset(materials, halves.soft), metric, options, listener);
  const streamed_pca specular = learn_streamed_pca(subset(materials, halves.specular), metric, options, listener);
  return {{soft.prior, specular.prior, halves.threshold},
          soft.exact && specular.exact,
          std::max(soft.residual, specular.residual)};
}

}  // namespace gonio
