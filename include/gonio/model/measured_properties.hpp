#pragma once
/// Checks the properties of physical BRDFs on measured tables and samples. J. B. Nielsen's thesis (2016), Sec. 2.2.
/// model/physical_properties.hpp has checks for any BRDF.

#include <gonio/core/direction.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

namespace gonio::model {

/// Statistics of a table's values.
struct table_values {
  rgb minimum, mean, maximum;       ///< smallest, mean and largest value of each channel over all cells, sr^-1
  Eigen::Index negative_cells = 0;  ///< number of cells with a negative value in any channel
  Eigen::Index lowest_cell = 0;     ///< the cell with the smallest value of any channel
};

/// Computes the statistics of a table. O(cells).
[[nodiscard]] table_values summarise(const brdf_table& table);

/// A rise of reflectance along theta_h after its peak.
struct tail_rise {
  double amount = 0.0;       ///< relative to the smallest value since the peak; 0 if the tails are monotone
  double theta_h = 0.0;      ///< in radians, at the end of the rise
  double theta_d = 0.0;      ///< in radians
  Eigen::Index channel = 0;  ///< 0, 1 or 2: red, green or blue
};

/// Averages the table over phi_d and returns the largest rise along theta_h after the peak: (v - least) / (least +
/// 0.001 sr^-1) for a value v and the smallest value since the peak. Such a rise is noise, stray light or a second
/// lobe. Only uses theta_h + theta_d of at most 70 degrees, so that neither light nor viewer grazes the surface.
/// O(cells).
[[nodiscard]] tail_rise largest_tail_rise(const brdf_table& table);

/// Pairs of samples that a symmetry makes equal, and their differences. The difference of a pair is the largest
/// difference in any channel, relative to the largest value.
struct equal_samples {
  Eigen::Index pairs = 0;
  double median = 0.0, worst = 0.0;    ///< 0 if there are no pairs
  Eigen::Index first = 0, second = 0;  ///< indices of the worst pair in the set, from 0
};

/// Samples that should be equal within a tolerance, by symmetry.
struct sample_symmetries {
  equal_samples repeated;    ///< pairs with the same directions, which differ by noise
  equal_samples turned;      ///< pairs rotated about the normal by more than ten tolerances, which test isotropy
  equal_samples reciprocal;  ///< pairs with light and viewer exchanged, possibly also rotated, which test reciprocity
};

/// Compares all pairs of samples whose directions agree within `tolerance` (radians, above 0 and at most 0.1) after a
/// rotation about the normal or an exchange of light and viewer. Each sample is compared with at most 100 later ones.
/// Weights are ignored, so samples of weight 0 are compared too. If all half vectors have azimuth 0, as for files with
/// half and difference angles, no rotated pairs are counted. O(n log n) if samples are spread out. Throws gonio::error
/// for unusable samples (`require_usable`) and for a tolerance out of range.
[[nodiscard]] sample_symmetries compare_equal_samples(const sample_set& samples, double tolerance = radians(0.5));

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/measured_properties.ipp>
#endif
