#pragma once
/// Bodies of metric/log_relative.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/metric/error_metric.hpp>
#include <gonio/metric/log_relative.hpp>
#include <gonio/table/material_set.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

namespace gonio {

GONIO_INLINE log_relative::log_relative(valid_cells cells, std::vector<float> reference) : cells_(std::move(cells)) {
  if (reference.size() != cells_.size())
    throw error{"a reference BRDF over ", cells_.size(), " cells has ", reference.size(), " values"};
  if (!std::ranges::all_of(reference, [](float value) { return value >= 0.0f && std::isfinite(value); }))
    throw error("a reference BRDF must be finite and not negative");
  reference_ = std::make_shared<const std::vector<float>>(std::move(reference));
}

GONIO_INLINE log_relative log_relative::to_median_of(const material_set& materials, thread_count threads) {
  if (materials.values.cols() == 0) throw error("the median of no material is not defined");
  std::vector<float> reference(materials.cells.size());
  for_each_block(
      reference.size(), 1024,
      [&](block range) {
        std::vector<float> row(static_cast<std::size_t>(materials.values.cols()));
        for (std::size_t cell = range.begin; cell < range.end; ++cell) {
          std::copy_n(materials.values.row(static_cast<Eigen::Index>(cell)).data(), row.size(), row.begin());
          reference[cell] = std::max(median(row), 0.0f);
        }
      },
      threads);
  return {materials.cells, std::move(reference)};
}

GONIO_INLINE log_relative log_relative::on(const valid_cells& cells) const {
  std::vector<float> moved(cells.size());
  for (std::size_t cell = 0; cell < moved.size(); ++cell)
    moved[cell] = static_cast<float>(reference(locate(cells_, cells.angles(cell))));
  return {cells, std::move(moved)};
}

GONIO_INLINE float log_relative::median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  if (values.size() % 2 != 0) return *middle;
  return 0.5f * (*middle + *std::ranges::max_element(values.begin(), middle));
}

}  // namespace gonio
