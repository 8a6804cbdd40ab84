#pragma once
/// How much a material shines, and a database split by that into soft and specular materials.
/// Nielsen, Jensen and Ramamoorthi 2015 (doi:10.1145/2816795.2818085), section 8: a database of mostly specular
/// materials makes soft ones ring; two priors are proposed, chosen between by the ratio of an in-peak sample to an
/// out-of-peak sample. Neither the directions of the two samples nor the ratio that divides them is in the paper: both
/// are ours.

#include <gonio/metric/log_relative.hpp>
#include <gonio/table/material_set.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// Where a highlight is, and where it is not, by theta_h in radians. What lies between belongs to neither.
struct highlight_regions {
  double in_peak = radians(5.0);    ///< a direction with theta_h up to this is in the peak
  double off_peak = radians(20.0);  ///< one with theta_h from this on is out of it
};

namespace detail {

/// Means of mapped luminances in the peak and out of it, of any number of materials at once.
struct contrast_sums {
  explicit contrast_sums(Eigen::Index materials)
      : in_peak(Eigen::ArrayXd::Zero(materials)), off_peak(Eigen::ArrayXd::Zero(materials)) {}

  contrast_sums& operator+=(const contrast_sums& other);

  /// Where the mapped luminances of a cell are added: the sums of its region, whose weight grows by 1. Null: of none.
  [[nodiscard]] Eigen::ArrayXd* region_of(const half_difference& angles, const highlight_regions& regions);

  [[nodiscard]] bool complete() const noexcept { return in_weight > 0.0 && off_weight > 0.0; }
  [[nodiscard]] Eigen::ArrayXd contrasts() const;
  /// The same of a grid's cells. Throws gonio::error if the regions have none.
  [[nodiscard]] Eigen::ArrayXd contrasts_of_cells() const;

  Eigen::ArrayXd in_peak, off_peak;
  double in_weight = 0.0, off_weight = 0.0;
};

/// Contrasts from the cells of tables: `luminance_of(cell, material)` reads them.
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

/// The contrast of a material's highlight from measurements: the logarithm of the ratio of an in-peak to an out-of-peak
/// luminance, both relative to the reference BRDF as the log-relative metric has it (Eq. 1-4). Zero: the material
/// shines as much as the reference; a Lambertian one is far below, a mirror far above. Where there are many samples in
/// a region, their mapped luminances are averaged by weight.
///
/// A plain ratio depends on where exactly the two samples lie, for highlights grow towards grazing; relative to the
/// reference it does so much less, and one threshold serves for any directions. Luminance below the metric's epsilon
/// counts as about epsilon, so that black in black has no contrast. Nothing, unless there is a sample of positive
/// weight in the peak and one out of it. Throws gonio::error for unusable samples. O(samples).
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

/// The same of a table: each of its cells is a sample of weight 1. Throws gonio::error if the grid has no cell in one
/// of the regions. O(cells), same bytes for any number of threads.
[[nodiscard]] double highlight_contrast(const log_relative& reference, const brdf_table& table,
                                        const highlight_regions& regions = {}, thread_count threads = {});

/// The same of each material of a set, in its order. Throws gonio::error as well if the set is not complete. O(cells
/// materials), same bytes for any number of threads.
[[nodiscard]] Eigen::ArrayXd highlight_contrasts(const log_relative& reference, const material_set& materials,
                                                 const highlight_regions& regions = {}, thread_count threads = {});

/// The numbers of soft and of specular materials, and the contrast between them.
struct parted_by_contrast {
  std::vector<Eigen::Index> soft, specular;
  double threshold = 0.0;
};

/// By their contrasts, as `split_by_contrast` does. Throws gonio::error if a half would be empty, or a contrast is not
/// finite.
[[nodiscard]] parted_by_contrast part_by_contrast(const std::vector<std::string>& names,
                                                  const Eigen::ArrayXd& contrasts, std::optional<double> threshold);

/// A database in two halves, and the contrast between them.
struct soft_and_specular {
  material_set soft, specular;
  double threshold = 0.0;
};

/// The materials whose contrast is below the threshold, and the others; without a threshold that is the median of
/// their contrasts, which makes two halves. Throws gonio::error if a half would be empty, or a table is not finite
/// in the regions. Copies the set: 4 bytes a value. O(cells materials).
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
