#pragma once
/// What `gonio design` and the experiments on directions search with.

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
  /// Beside the criteria of the command line there is perceived-norm: the expected error in the norm of that name,
  /// which is what perceived is of images.
  std::string geometry = "point", criterion = "perceived", search = "greedy";
  gonio::design::apparatus apparatus = gonio::design::usual_apparatus();  ///< its angular error is of points
  double eta = gonio::default_eta;
  double common_shift = 0.0;                     ///< of every measurement's logarithm, shared by all
  bool in_sample = false;                        ///< is the error expected of materials that the prior has seen?
  gonio::design::near_field_options near_field;  ///< its constraint is that of the apparatus
  std::vector<gonio::direction_pair> start;      ///< above the horizon
  std::uint64_t seed = 0;
  gonio::thread_count threads;
};

/// What to measure.
struct designed {
  std::vector<gonio::direction_pair> poses;     ///< light and viewer of each measurement; of an image, its centre
  std::vector<gonio::half_difference> samples;  ///< of all measurements, one for each pixel
  double value = 0.0;                           ///< of the criterion
};

/// The processes share each sweep over all candidates, and those of an earlier run are not done again. Throws
/// gonio::error where there is not as much to choose from.
[[nodiscard]] designed design(const gonio::log_relative_pca& prior, const design_options& options,
                              const gonio::progress& listener = {}, const team& processes = alone(),
                              sweep_record* record = nullptr);

/// What is measured at some poses: at the candidates of the options' geometry that are nearest to them.
[[nodiscard]] designed placed(const gonio::log_relative_pca& prior, const design_options& options,
                              const std::vector<gonio::direction_pair>& poses);

/// The expected error of measurements: root mean square over the cells, in the mapped domain; and as a share of what it
/// is with nothing measured. It is that of materials left out of the prior one by one, unless the options say
/// otherwise.
struct design_quality {
  double expected_error = 0.0, unknown_share = 0.0;
};
[[nodiscard]] design_quality quality_of(const gonio::log_relative_pca& prior, const design_options& options,
                                        const designed& found);

}  // namespace cli
