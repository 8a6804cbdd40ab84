#pragma once
/// The searches of `gonio design` and of the experiments on directions.

#include "team.hpp"
#include "tool/files/sweep_record.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/design/apparatus.hpp>
#include <gonio/design/near_field_geometry.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/solve/default_eta.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace cli {

struct design_options {
  Eigen::Index count = 20;
  /// In addition to the command line's criteria there is perceived-norm: the expected error in the norm of that name,
  /// which is also the meaning of perceived for images.
  std::string geometry = "point", criterion = "perceived", search = "greedy";
  gonio::design::apparatus apparatus = gonio::design::usual_apparatus();  ///< its angular error applies to points
  double eta = gonio::default_eta;
  double common_shift = 0.0;                     ///< of the logarithm, shared by all measurements
  bool in_sample = false;                        ///< expect the error of materials that the prior has seen
  gonio::design::near_field_options near_field;  ///< its constraint is replaced by the apparatus'
  std::vector<gonio::direction_pair> start;      ///< above the horizon
  std::uint64_t seed = 0;
  gonio::thread_count threads;
};

/// The measurements of a design.
struct designed {
  std::vector<gonio::direction_pair> poses;     ///< light and viewer of each measurement (of an image: at its centre)
  std::vector<gonio::half_difference> samples;  ///< of all measurements, one per pixel
  double value = 0.0;                           ///< value of the criterion
};

/// Searches for a design. The processes share each sweep over all candidates, and sweeps of an earlier run are not
/// repeated. Throws gonio::error if there are too few candidates.
[[nodiscard]] designed design(const gonio::log_relative_pca& prior, const design_options& options,
                              const gonio::progress& listener = {}, const team& processes = alone(),
                              sweep_record* record = nullptr);

/// Returns the measurements at the candidates of the options' geometry that are nearest to some poses.
[[nodiscard]] designed placed(const gonio::log_relative_pca& prior, const design_options& options,
                              const std::vector<gonio::direction_pair>& poses);

/// The expected error of measurements: root mean square over the cells, in the mapped domain; and the same as a
/// fraction of the error without measurements. It is the error of materials left out of the prior one by one, unless
/// the options state otherwise.
struct design_quality {
  double expected_error = 0.0, unknown_share = 0.0;
};
[[nodiscard]] design_quality quality_of(const gonio::log_relative_pca& prior, const design_options& options,
                                        const designed& found);

}  // namespace cli
