#pragma once
/// Whether measurements keep what a physical BRDF keeps: tables and samples. J. B. Nielsen's thesis (2016), Sec. 2.2;
/// for a BRDF of any kind model/physical_properties.hpp.

#include <gonio/core/direction.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

namespace gonio::model {

/// The values of a table.
struct table_values {
  rgb minimum, mean, maximum;       ///< of each channel over all cells, sr^-1
  Eigen::Index negative_cells = 0;  ///< with a negative value in any channel
  Eigen::Index lowest_cell = 0;     ///< which has the least value of any channel
};

/// O(cells).
[[nodiscard]] table_values summarise(const brdf_table& table);

/// Where reflectance rises along theta_h although its peak has been passed.
struct tail_rise {
  double amount = 0.0;       ///< relative to the least value before it; 0: the tails are monotone
  double theta_h = 0.0;      ///< in radians, where it ends
  double theta_d = 0.0;      ///< in radians
  Eigen::Index channel = 0;  ///< red, green or blue
};

/// The largest rise of the mean over phi_d along theta_h, from the peak on: (v - least) / (least + 0.001 sr^-1) for the
/// least value since the peak. A measurement that rises there is noise, stray light, or a second lobe. Only where
/// theta_h + theta_d is at most 70 degrees, so that neither light nor viewer grazes the surface. O(cells).
[[nodiscard]] tail_rise largest_tail_rise(const brdf_table& table);

/// Samples that a property makes equal, and by how much they differ: the largest difference of a channel as a share of
/// the largest value.
struct equal_samples {
  Eigen::Index pairs = 0;
  double median = 0.0, worst = 0.0;    ///< 0 if there are no pairs
  Eigen::Index first = 0, second = 0;  ///< the worst pair's numbers in the set, from 0
};

/// Which samples ought to be equal, up to a tolerance.
struct sample_symmetries {
  equal_samples repeated;    ///< the same directions: the noise
  equal_samples turned;      ///< both turned about the normal, by ten tolerances at least: isotropy
  equal_samples reciprocal;  ///< light and viewer swapped, and perhaps turned: reciprocity
};

/// Compares all pairs of samples whose directions agree to `tolerance` (radians, above 0 and at most 0.1) after a turn
/// about the normal or a swap, each sample with at most a hundred others that come after it. Weights do not count: a
/// sample of weight 0 is compared, too. Where all half vectors have the azimuth 0, as which half and difference angles
/// are read, nothing is turned. O(n log n) where samples are spread. Throws gonio::error for unusable samples
/// (`require_usable`) and a tolerance out of its range.
[[nodiscard]] sample_symmetries compare_equal_samples(const sample_set& samples, double tolerance = radians(0.5));

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/measured_properties.ipp>
#endif
