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
  /// `criterion` is one of the command line's criteria, or perceived-norm: the expected error in the perceived norm.
  /// For images, perceived has the same meaning as perceived-norm.
  std::string geometry = "point", criterion = "perceived", search = "greedy";
  gonio::design::apparatus apparatus = gonio::design::usual_apparatus();  ///< angular_error is for points only
  double eta = gonio::default_eta;
  double common_shift = 0.0;                     ///< size of a shift of all mapped values
  bool in_sample = false;                        ///< expect the error of materials that the prior has seen
  gonio::design::near_field_options near_field;  ///< its constraint is not used: `apparatus` has the limits
  std::vector<gonio::direction_pair> start;      ///< directions measured already, above the horizon
  std::uint64_t seed = 0;
  gonio::thread_count threads;
};

/// The measurements of a design.
struct designed {
  std::vector<gonio::direction_pair> poses;     ///< light and viewer of each measurement (of an image: at its centre)
  std::vector<gonio::half_difference> samples;  ///< of all measurements, one per pixel
  double value = 0.0;                           ///< value of the criterion
};

/// Searches for a design. The processes share each sweep over all candidates; sweeps in `record`, from an earlier run,
/// are not repeated. Throws gonio::error if there are too few candidates.
[[nodiscard]] designed design(const gonio::log_relative_pca& prior, const design_options& options,
                              const gonio::progress& listener = {}, const team& processes = alone(),
                              sweep_record* record = nullptr);

/// Returns the design at the candidates nearest to the poses.
[[nodiscard]] designed placed(const gonio::log_relative_pca& prior, const design_options& options,
                              const std::vector<gonio::direction_pair>& poses);

/// The expected error of a design: root mean square over the cells in the mapped domain, and as a share of the error
/// without measurements. Each material is left out of the prior, unless `in_sample` is set.
struct design_quality {
  double expected_error = 0.0, unknown_share = 0.0;
};
[[nodiscard]] design_quality quality_of(const gonio::log_relative_pca& prior, const design_options& options,
                                        const designed& found);

}  // namespace cli
