#pragma once
/// The error measures of the experiments after Noell et al. 2014.

#include "papers/experiments.hpp"
#include "tool/files/json.hpp"
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/sphere_delta_e.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/render/environment_map.hpp>

#include <filesystem>
#include <optional>

namespace papers {

/// Adds the optional `--environment FILE`.
inline void add_environment_option(command& to, std::filesystem::path& environment) {
  to.add_input("--environment", environment,
               "Latitude-longitude image of a natural light (.hdr), under which errors are measured, too");
}

/// Compares tables over given cells under the formula environment and, if there is one, a natural light.
class noell_measures {
 public:
  noell_measures(const gonio::valid_cells& cells, const std::filesystem::path& environment, gonio::thread_count threads)
      : formula_(cells, 36, threads), threads_(threads) {
    if (!environment.empty())
      natural_.emplace(
          cells,
          gonio::render::environment_lighting(90, 72, gonio::render::environment_map(gonio::io::read_hdr(environment))),
          36, gonio::sphere_delta_e::middle_grey, threads);
  }

  /// Returns delta_e_env under the formula environment at the exposure of a white sphere, delta_e_natural (if there is
  /// an environment) at the truth's own exposure, and peak_ratio of the green highlight with theta_d below 70 degrees.
  [[nodiscard]] json judge(const gonio::brdf_table& estimate, const gonio::brdf_table& truth) const {
    const double limit = gonio::radians(70.0);
    json result{{"delta_e_env", formula_.difference(estimate, truth, threads_).environment},
                {"peak_ratio", gonio::highlight_peak(estimate, limit).y() / gonio::highlight_peak(truth, limit).y()}};
    if (natural_) result["delta_e_natural"] = natural_->difference(estimate, truth, threads_);
    return result;
  }

 private:
  gonio::appearance_metric formula_;
  std::optional<gonio::sphere_delta_e> natural_;
  gonio::thread_count threads_;
};

}  // namespace papers
