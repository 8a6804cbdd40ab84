#pragma once
/// Measures how much a material shines, and splits a database into soft and specular materials. Nielsen, Jensen and
/// Ramamoorthi 2015 (doi:10.1145/2816795.2818085), section 8: if most materials of the database are specular,
/// reconstructions of soft materials have ringing artefacts. The paper proposes two priors, chosen by the ratio of an
/// in-peak to an out-of-peak sample. The directions of these samples and the threshold are ours, because the paper does
/// not state them.

#include <gonio/metric/log_relative.hpp>
#include <gonio/table/material_set.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// The regions inside and outside of a highlight, by theta_h in radians. Directions between the two belong to neither.
struct highlight_regions {
  double in_peak = radians(5.0);    ///< a direction with theta_h up to this is in the peak
  double off_peak = radians(20.0);  ///< a direction with theta_h from this on is out of the peak
};

namespace detail {

/// Sums of mapped luminances inside and outside of the peak, for any number of materials at once.
struct contrast_sums {
  explicit contrast_sums(Eigen::Index materials)
      : in_peak(Eigen::ArrayXd::Zero(materials)), off_peak(Eigen::ArrayXd::Zero(materials)) {}

  contrast_sums& operator+=(const contrast_sums& other);

  /// Returns the sums of the region that contains a cell, and adds 1 to the region's weight. Returns a null pointer for
  /// a cell outside of both regions.
  [[nodiscard]] Eigen::ArrayXd* region_of(const half_difference& angles, const highlight_regions& regions);

  [[nodiscard]] bool complete() const noexcept { return in_weight > 0.0 && off_weight > 0.0; }
  [[nodiscard]] Eigen::ArrayXd contrasts() const;
  /// Returns the contrasts, if each cell of a grid was added once. Throws gonio::error if a region has no cells.
  [[nodiscard]] Eigen::ArrayXd contrasts_of_cells() const;

  Eigen::ArrayXd in_peak, off_peak;
  double in_weight = 0.0, off_weight = 0.0;
};

/// Computes contrasts from the cells of tables. `luminance_of(cell, material)` returns a cell's luminance.
template <class Luminance>
[[nodiscard]] Eigen::ArrayXd cell_contrasts(const log_relative& reference, const valid_cells& cells,
                                            Eigen::Index materials, Luminance&& luminance_of,
                                            const highlight_regions& regions, thread_count threads) {
  const bool own = cells == reference.cells();
  const contrast_sums sums = sum_over_blocks(
      cells.size(), 1024, contrast_sums(materials),
      [&](contrast_sums& sum, block range) {
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
          Eigen::ArrayXd* mapped = sum.region_of(cells.angles(cell), regions);
          if (mapped == nullptr) continue;
          const location at = own ? locate_cell(cells, cell) : locate(reference.cells(), cells.angles(cell));
          const double rho_ref = reference.reference(at), weight = reference.cosine_weight(at.cosine);
          for (Eigen::Index m = 0; m < materials; ++m)
            (*mapped)[m] += log_relative::forward(luminance_of(cell, m), rho_ref, weight);
        }
      },
      threads);
  return sums.contrasts_of_cells();
}

}  // namespace detail

/// Returns the contrast of a material's highlight from measurements: the logarithm of the ratio of in-peak to
/// out-of-peak luminance, each relative to the reference BRDF as in the log-relative metric (Eq. 1-4). A contrast of
/// zero means that the material shines as much as the reference; a Lambertian material is far below zero, a mirror far
/// above. The mapped luminances of several samples in a region are averaged by weight.
///
/// A plain ratio of luminances depends on the exact directions of the samples, because highlights grow towards grazing
/// angles. Relative to the reference, the dependence is much weaker, and one threshold suits all directions. Luminance
/// far below the metric's epsilon counts as about epsilon, so a black material is as soft as a Lambertian one. Returns
/// nothing unless a sample of positive weight is in the peak and another is out of the peak. Throws gonio::error for
/// unusable samples. O(samples).
template <sample_range Samples>
[[nodiscard]] std::optional<double> highlight_contrast(const log_relative& reference, const Samples& samples,
                                                       const highlight_regions& regions = {}) {
  require_usable(samples);
  detail::contrast_sums sums(1);
  for (const sample& s : samples) {
    const bool in_peak = s.angles().theta_h <= regions.in_peak;
    if (!in_peak && s.angles().theta_h < regions.off_peak) continue;
    const double mapped = reference.forward(luminance(s.value), locate(reference.cells(), s.angles()));
    (in_peak ? sums.in_peak : sums.off_peak)[0] += s.weight.mean() * mapped;
    (in_peak ? sums.in_weight : sums.off_weight) += s.weight.mean();
  }
  if (!sums.complete()) return {};
  return sums.contrasts()[0];
}

/// Returns the contrast of a table, whose cells are samples of weight 1. Throws gonio::error if the grid has no cell in
/// one of the regions. O(cells). Any number of threads gives the same bytes.
[[nodiscard]] double highlight_contrast(const log_relative& reference, const brdf_table& table,
                                        const highlight_regions& regions = {}, thread_count threads = {});

/// Returns the contrast of each material of a set, in the order of the set. Throws gonio::error if the grid has no cell
/// in one of the regions, or if the set is not complete. O(cells materials). Any number of threads gives the same
/// bytes.
[[nodiscard]] Eigen::ArrayXd highlight_contrasts(const log_relative& reference, const material_set& materials,
                                                 const highlight_regions& regions = {}, thread_count threads = {});

/// The positions of soft and of specular materials, and the contrast that separates them.
struct parted_by_contrast {
  std::vector<Eigen::Index> soft, specular;
  double threshold = 0.0;
};

/// Splits materials by their contrasts, as `split_by_contrast` does. Throws gonio::error if there would be no soft or
/// no specular material, or if a contrast is not finite.
[[nodiscard]] parted_by_contrast part_by_contrast(const std::vector<std::string>& names,
                                                  const Eigen::ArrayXd& contrasts, std::optional<double> threshold);

/// The soft and the specular materials of a database, and the contrast that separates them.
struct soft_and_specular {
  material_set soft, specular;
  double threshold = 0.0;
};

/// Splits a set into soft materials, whose contrast is below the threshold, and specular ones. The default threshold is
/// the median of the contrasts. Throws gonio::error if there would be no soft or no specular material, or if a table is
/// not finite in the regions. Copies the set: 4 bytes a value. O(cells materials).
///
/// ```cpp
/// const auto reference = gonio::log_relative::to_median_of(materials);
/// const auto [soft, specular, threshold] = gonio::split_by_contrast(materials, reference);
/// ```
[[nodiscard]] soft_and_specular split_by_contrast(const material_set& materials, const log_relative& reference,
                                                  std::optional<double> threshold = {},
                                                  const highlight_regions& regions = {}, thread_count threads = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/highlight_contrast.ipp>
#endif
