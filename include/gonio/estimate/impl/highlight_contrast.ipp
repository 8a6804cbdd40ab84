#pragma once
/// Bodies of estimate/highlight_contrast.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/highlight_contrast.hpp>
#include <gonio/metric/log_relative.hpp>
#include <gonio/table/material_set.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <optional>
#include <utility>
#include <vector>

namespace gonio::detail {

GONIO_INLINE contrast_sums& contrast_sums::operator+=(const contrast_sums& other) {
  in_peak += other.in_peak;
  off_peak += other.off_peak;
  in_weight += other.in_weight;
  off_weight += other.off_weight;
  return *this;
}

GONIO_INLINE Eigen::ArrayXd contrast_sums::contrasts() const { return in_peak / in_weight - off_peak / off_weight; }

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE double highlight_contrast(const log_relative& reference, const brdf_table& table,
                                       const highlight_regions& regions, thread_count threads) {
  return detail::cell_contrasts(
      reference, table.cells(), 1, [&](Eigen::Index cell, Eigen::Index) { return luminance(table.at(cell)); }, regions,
      threads)[0];
}

GONIO_INLINE Eigen::ArrayXd highlight_contrasts(const log_relative& reference, const material_set& materials,
                                                const highlight_regions& regions, thread_count threads) {
  require_complete(materials);
  const auto luminance_of = [&](Eigen::Index cell, Eigen::Index material) {
    const Eigen::Array3f value = materials.values.row(cell).segment<3>(3 * material).transpose();
    return luminance(value.cast<double>());
  };
  return detail::cell_contrasts(reference, materials.cells, std::ssize(materials.names), luminance_of, regions,
                                threads);
}

GONIO_INLINE soft_and_specular split_by_contrast(const material_set& materials, const log_relative& reference,
                                                 std::optional<double> threshold, const highlight_regions& regions,
                                                 thread_count threads) {
  const Eigen::ArrayXd contrasts = highlight_contrasts(reference, materials, regions, threads);
  std::vector<Eigen::Index> soft, specular;
  for (Eigen::Index m = 0; m < std::ssize(materials.names); ++m)
    if (!std::isfinite(contrasts[m]))
      refuse({"material '", materials.names[m], "' has no contrast: its table is not finite"});
  if (!threshold) {
    threshold = median(std::vector<double>(contrasts.begin(), contrasts.end()));
  }
  for (Eigen::Index m = 0; m < std::ssize(materials.names); ++m)
    (contrasts[m] < *threshold ? soft : specular).push_back(m);
  if (soft.empty() || specular.empty())
    refuse({"all ", materials.names.size(), " materials are ", (soft.empty() ? "specular" : "soft"),
            " at a threshold of ", *threshold, ": a prior needs some on either side"});
  return {materials.subset(soft), materials.subset(specular), *threshold};
}

}  // namespace gonio
