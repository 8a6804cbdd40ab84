#pragma once
/// Bodies of metric/log_relative.hpp.

#include <gonio/core/assertion.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/metric/error_metric.hpp>
#include <gonio/metric/log_relative.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

namespace gonio {

GONIO_INLINE log_relative::log_relative(valid_cells cells, std::vector<float> reference, cosine_weighting weighting)
    : cells_(std::move(cells)), weighting_(weighting) {
  if (std::ssize(reference) != cells_.size())
    refuse({"a reference BRDF over ", cells_.size(), " cells has ", reference.size(), " values"});
  for (const float value : reference)
    if (!(value >= 0.0f && std::isfinite(value))) refuse("a reference BRDF must be finite and not negative");
  std::vector<float> logarithms(reference.size());
  std::ranges::transform(reference, logarithms.begin(),
                         [](float value) { return static_cast<float>(log_reference(value)); });
  reference_ = std::make_shared<const std::vector<float>>(std::move(reference));
  log_reference_ = std::make_shared<const std::vector<float>>(std::move(logarithms));
}

GONIO_INLINE log_relative log_relative::to_median_of(const valid_cells& cells, const cell_matrix& values,
                                                     thread_count threads) {
  if (values.cols() == 0) refuse("a median needs at least one material");
  std::vector<float> reference(cells.size());
  for_each_block(
      reference.size(), 1024,
      [&](block range) {
        std::vector<float> row(values.cols());
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
          std::copy_n(values.data() + cell * row.size(), row.size(), row.begin());
          reference[cell] = std::max(median(row), 0.0f);
        }
      },
      threads);
  return {cells, std::move(reference)};
}

GONIO_INLINE log_relative log_relative::on(const valid_cells& cells) const {
  std::vector<float> moved(cells.size());
  for (Eigen::Index cell = 0; cell < std::ssize(moved); ++cell)
    moved[cell] = static_cast<float>(reference(locate(cells_, cells.angles(cell))));
  return {cells, std::move(moved), weighting_};
}

GONIO_INLINE void log_relative::compute_shifts(const cell_row& row, Eigen::Index begin, std::span<float> shift) const {
  // Use expressions without branches, which are computed for several cells at once.
  Eigen::Array<double, Eigen::Dynamic, 1, 0, shifts_at_once> weight(shift.size());
  const auto part =
      row.difference * Eigen::Map<const Eigen::ArrayXd>(row.cos_phi_d + row.first_phi_d + begin, weight.size());
  if (weighting_ == cosine_weighting::product)
    weight = ((row.sum - part) * (row.sum + part)).max(epsilon);
  else
    weight = (row.sum - part).max(row.sum + part).max(epsilon);
  for (Eigen::Index i = 0; i < weight.size(); ++i)
    shift[i] = static_cast<float>(epsilon) / static_cast<float>(weight[i]);
}

}  // namespace gonio
