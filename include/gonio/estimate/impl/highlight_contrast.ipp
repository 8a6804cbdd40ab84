#pragma once
/// Bodies of estimate/highlight_contrast.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/highlight_contrast.hpp>
#include <gonio/metric/log_relative.hpp>
#include <gonio/table/material_set.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <cmath>
#include <optional>
#include <string>
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

GONIO_INLINE Eigen::ArrayXd* contrast_sums::region_of(const half_difference& angles, const highlight_regions& regions) {
  const bool is_in_peak = angles.theta_h <= regions.in_peak;
  if (!is_in_peak && angles.theta_h < regions.off_peak) return nullptr;
  (is_in_peak ? in_weight : off_weight) += 1.0;
  return is_in_peak ? &in_peak : &off_peak;
}

GONIO_INLINE Eigen::ArrayXd contrast_sums::contrasts() const { return in_peak / in_weight - off_peak / off_weight; }

GONIO_INLINE Eigen::ArrayXd contrast_sums::contrasts_of_cells() const {
  if (!complete()) refuse("the grid is too coarse: it needs cells inside and outside the peak");
  return contrasts();
}

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

GONIO_INLINE parted_by_contrast part_by_contrast(const std::vector<std::string>& names, const Eigen::ArrayXd& contrasts,
                                                 std::optional<double> threshold) {
  for (Eigen::Index m = 0; m < contrasts.size(); ++m)
    if (!std::isfinite(contrasts[m])) refuse({"material '", names[m], "' has no contrast: its table is not finite"});
  parted_by_contrast parted;
  parted.threshold = threshold ? *threshold : median(std::vector<double>(contrasts.begin(), contrasts.end()));
  for (Eigen::Index m = 0; m < contrasts.size(); ++m)
    (contrasts[m] < parted.threshold ? parted.soft : parted.specular).push_back(m);
  if (parted.soft.empty() || parted.specular.empty())
    refuse({"all ", names.size(), " materials are ",
            parted.soft.empty() ? "specular (contrast of at least " : "soft (contrast below ", parted.threshold,
            "): a split prior needs soft and specular materials"});
  return parted;
}

GONIO_INLINE soft_and_specular split_by_contrast(const material_set& materials, const log_relative& reference,
                                                 std::optional<double> threshold, const highlight_regions& regions,
                                                 thread_count threads) {
  const parted_by_contrast parted =
      part_by_contrast(materials.names, highlight_contrasts(reference, materials, regions, threads), threshold);
  return {materials.subset(parted.soft), materials.subset(parted.specular), parted.threshold};
}

}  // namespace gonio
