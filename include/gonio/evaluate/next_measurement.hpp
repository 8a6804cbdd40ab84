#pragma once
/// Chooses the next measurement, given those already made. It minimises the expected visible error of the estimate on
/// spheres. Glossy materials need other directions than matte ones. Results on measured materials, with families left
/// out: docs/results/adaptive-design.md.

#include <gonio/design/search.hpp>
#include <gonio/design/sequential_design.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/evaluate/perceived_sensitivity.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace gonio {

struct next_measurement {
  direction_pair pose;            ///< light and viewer
  half_difference angles;         ///< half and difference angles of `pose`
  double expected_delta_e = 0.0;  ///< rms Delta E after the measurement, averaged over sphere points
};

/// Chooses measurements for an estimator. It linearises the perceived error at the estimate, so the choice depends on
/// the values of the samples. (The uncertainty of a Gaussian process depends only on their directions.)
///
/// ```cpp
/// const gonio::measurement_chooser chooser{gonio::reconstruction{prior}};
/// const auto next = chooser.choose(samples, 1).front();
/// ```
template <error_metric Metric>
class measurement_chooser {
 public:
  /// Throws gonio::error if the apparatus cannot measure any candidate.
  explicit measurement_chooser(reconstruction<Metric> estimator, const design::apparatus& with = {},
                               valid_cells candidates = design::default_candidates(), thread_count threads = {})
      : design_(std::move(estimator), with, std::move(candidates)),
        perceived_(design_.geometry().cells(), 14, threads),
        threads_(threads) {
    design::detail::require_choice(1, design_.geometry());
  }

  [[nodiscard]] const design::sequential_design<Metric>& candidates() const noexcept { return design_; }

  /// Returns the best `count` measurements to add to some samples, chosen one after another without knowing their
  /// readings. Chooses no cell that already has a sample, and no pose that the apparatus or `is_reachable` excludes.
  /// O(count points candidates^2). Throws gonio::error for unusable samples, and if fewer than `count` candidates are
  /// left.
  [[nodiscard]] std::vector<next_measurement> choose(
      const sample_set& samples, Eigen::Index count,
      const std::function<bool(const direction_pair&)>& is_reachable = {}) const {
    std::vector<bool> free = free_candidates(samples);
    for (Eigen::Index i = 0; is_reachable && i < std::ssize(free); ++i)
      free[i] = free[i] && is_reachable(design_.geometry().centre(i));
    if (const auto left = std::ranges::count(free, true); left < count)
      refuse({"a count of ", count, " exceeds the ", left, " directions that can be reached and are not measured yet"});
    std::optional<sample_process> process;
    if (!samples.empty()) process = design_.estimator().process_of_inliers(locate(samples));
    design::candidate_posterior known = process ? design_.posterior_of(*process) : design_.prior();
    const design::sensitivity seen =
        perceived_.at(design_.estimator().prior().metric(), design_.locations(), known.mean);
    const double scale = process ? process->scale() : 1.0;
    std::vector<next_measurement> chosen;
    while (std::ssize(chosen) < count) {
      const std::vector<double> deviations =
          design::seen_deviation_with_each(known.covariance, seen, design_.error_variances(), threads_);
      const auto value = [&](Eigen::Index i) {
        return free[i] ? deviations[i] : std::numeric_limits<double>::infinity();
      };
      Eigen::Index best = 0;
      for (Eigen::Index i = 1; i < std::ssize(deviations); ++i)
        if (value(i) < value(best)) best = i;
      free[best] = false;
      known.add(best, design_.error_variances()[best]);
      const direction_pair pose = design_.geometry().centre(best);
      chosen.push_back({pose, to_half_difference(pose.wi, pose.wo), std::sqrt(scale) * deviations[best]});
    }
    return chosen;
  }

 private:
  [[nodiscard]] located_samples locate(const sample_set& samples) const {
    return locate_samples(design_.estimator().prior().cells(), samples, threads_);
  }

  /// Returns the candidates that the constraint allows and whose cell contains no sample.
  [[nodiscard]] std::vector<bool> free_candidates(const sample_set& samples) const {
    const design::point_geometry& geometry = design_.geometry();
    std::vector<bool> free(geometry.size());
    for (Eigen::Index i = 0; i < geometry.size(); ++i) free[i] = geometry.allows(i);
    const valid_cells& cells = geometry.cells();
    for (Eigen::Index i = 0; i < std::ssize(samples); ++i)
      free[cells.representative(cells.grid().linear(cells.grid().nearest(samples.directions(i).angles())))] = false;
    return free;
  }

  design::sequential_design<Metric> design_;
  perceived_sensitivity perceived_;
  thread_count threads_;
};

}  // namespace gonio
