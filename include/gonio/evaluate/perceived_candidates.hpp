#pragma once
/// Scores candidates for a measurement by the visible error: the mean Delta E of spheres between a prior's materials
/// and their `reconstruction` from samples, with each material's family left out of the prior. It plans before any
/// reading; `next_measurement.hpp` plans after the first readings. docs/results/adaptive-design.md compares criteria on
/// measured materials.

#include <gonio/core/parallel.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/design/sequential_design.hpp>
#include <gonio/evaluate/perceived_sensitivity.hpp>
#include <gonio/metric/error_metric.hpp>
#include <gonio/table/channels.hpp>
#include <gonio/table/location.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

struct perceived_options {
  /// The Delta E of a point combines the variance that the process states with the squared error of the material's
  /// reconstruction. This is the weight of the variance, from 0 to 1; the squared error has the rest.
  double variance_share = 0.5;
  Eigen::Index most_materials = 48;  ///< the largest number of materials, evenly spaced among all
  int sphere_size = 8;               ///< number of points across each sphere
  /// The criterion is the power mean of the materials' Delta E with this exponent. 1 gives the mean, 8 nearly the
  /// maximum.
  double power = 1.0;
};

namespace detail {

/// Converts mapped values of channels of any kind, n x c, to the three channels of `channels::three`: n x 3.
template <error_metric Metric>
[[nodiscard]] Eigen::MatrixXd mapped_in_three_channels(const Metric& metric, std::span<const location> locations,
                                                       const Eigen::MatrixXd& mapped, const channels& kinds) {
  if (kinds.are_colours()) return mapped;
  Eigen::MatrixXd three(mapped.rows(), 3);
  std::vector<double> reflectance(static_cast<std::size_t>(kinds.size()));
  for (Eigen::Index i = 0; i < mapped.rows(); ++i) {
    for (Eigen::Index c = 0; c < mapped.cols(); ++c) reflectance[c] = metric.inverse(mapped(i, c), locations[i]);
    const rgb seen = kinds.three(reflectance);
    for (Eigen::Index c = 0; c < 3; ++c) three(i, c) = metric.forward(std::max(seen[c], 0.0), locations[i]);
  }
  return three;
}

}  // namespace detail

/// A `design::sweeping_objective`. Its value is the mean Delta E over the materials, linearised at each; with
/// `perceived_options::power` it is a power mean.
///
/// Let P be the covariance of the process without a family, y the mapped values of one of the family's materials, and
/// y_X its samples, with the covariance K. A point of a sphere with the slopes s then has the error e = s (y - P_X K^-1
/// y_X), and the process states the variance v = s (P - P_X K^-1 P_X') s'. The Delta E of the point is the square root
/// of a weighted mean of e^2 and v, summed over the channels. One more sample changes e and v by an update of rank one.
///
/// ```cpp
/// const gonio::design::sequential_design cells(gonio::reconstruction{prior}, gonio::design::usual_apparatus());
/// const gonio::perceived_candidates candidates(cells);
/// const auto plan = gonio::design::exchange(candidates, gonio::design::grow_greedily(candidates, 20));
/// ```
class perceived_candidates {
 public:
  /// Needs 4 bytes for each candidate, point, channel and material: 190 MB by default. At most O(candidates^2 x points
  /// x materials). Throws gonio::error for options out of range, and unless the prior has two families.
  template <error_metric Metric>
  explicit perceived_candidates(const design::sequential_design<Metric>& candidates,
                                const perceived_options& options = {}, thread_count threads = {})
      : perceived_candidates(candidates.geometry(), candidates.rows(), candidates.error_variances(),
                             candidates.estimator().expected(), options, threads) {
    const auto& prior = candidates.estimator().prior();
    const perceived_sensitivity perceived(geometry_.cells(), options.sphere_size, threads);
    weights_ = perceived.weights().cast<float>();
    const channels kinds = prior.wavelengths().empty() ? channels() : channels(prior.wavelengths());
    const Eigen::MatrixXf discrepancy = discrepancy_factor();
    for (const family& some : families_of(prior.names())) {
      Eigen::MatrixXd members(prior.size(), kinds.size() * std::ssize(some.members));
      for (Eigen::Index i = 0; i < std::ssize(some.members); ++i)
        members.middleCols(kinds.size() * i, kinds.size()) = prior.weights_of(some.members[i]);
      std::vector<seen_material> seen;
      for (const Eigen::Index material : some.judged) {
        const Eigen::MatrixXd own = (rows_.rows * prior.weights_of(material)).colwise() + candidates.offsets();
        const Eigen::MatrixXd three =
            detail::mapped_in_three_channels(prior.metric(), candidates.locations(), own, kinds);
        seen_material each{three.colwise() - candidates.offsets(),
                           perceived.at(prior.metric(), candidates.locations(), three)};
        seen.push_back(std::move(each));
      }
      leave_out(members, seen, discrepancy);
    }
  }

  [[nodiscard]] const design::point_geometry& geometry() const noexcept { return geometry_; }
  [[nodiscard]] Eigen::Index materials() const noexcept { return materials_; }

  /// Returns the value for measurements at n candidates. O(n points materials).
  [[nodiscard]] double operator()(std::span<const Eigen::Index> cells) const;

  /// Returns one value for each candidate: the value for measurements at `cells` and at this candidate, or infinity if
  /// the apparatus cannot reach the candidate. O(candidates n points materials) for n cells.
  [[nodiscard]] std::vector<float> errors_with_each(std::span<const Eigen::Index> cells) const;
  /// Returns the values of `errors_with_each(cells)`, with the same bytes, for a range of the candidates. The range
  /// must begin at a multiple of `sweep_block`.
  [[nodiscard]] std::vector<float> errors_with_each(std::span<const Eigen::Index> cells, block range) const;

  static constexpr Eigen::Index sweep_block = 64;

 private:
  /// Positions of a family's materials among a prior's names: of all members, and of the members that are evaluated.
  struct family {
    std::vector<Eigen::Index> members, judged;
  };
  /// The mapped values of a material at the n candidates in three channels, n x 3, minus the prior's mean.
  struct seen_material {
    Eigen::MatrixXd mapped;
    design::sensitivity slopes;
  };
  /// A family's materials under the prior of all other families: P = Q W + the discrepancy's covariance.
  struct excluded_family {
    Eigen::MatrixXd weights;            ///< W: k x n
    Eigen::MatrixXd mapped;             ///< n x 3 per material, minus the mean of the other families
    Eigen::MatrixXf seen;               ///< s P: (points of each material and channel) x n
    Eigen::VectorXf errors, variances;  ///< e and v before any measurement
    [[nodiscard]] Eigen::Index materials() const noexcept { return mapped.cols() / 3; }
  };
  struct remainder;

  perceived_candidates(design::point_geometry geometry, located_rows rows, Eigen::VectorXd error_variances,
                       const expected_covariance& expected, const perceived_options& options, thread_count threads);

  [[nodiscard]] std::vector<family> families_of(const std::vector<std::string>& names) const;
  /// Returns F such that F F' is the discrepancy's covariance, with an error of up to a hundredth of its variance.
  [[nodiscard]] Eigen::MatrixXf discrepancy_factor() const;
  /// Leaves a family out of the prior. `members` has a column for each of the family's observations.
  void leave_out(const Eigen::MatrixXd& members, const std::vector<seen_material>& seen,
                 const Eigen::MatrixXf& discrepancy);
  [[nodiscard]] remainder remains(const excluded_family& some, std::span<const Eigen::Index> cells) const;
  /// Returns the mean Delta E of one material, raised to `perceived_options::power`, from the errors e and variances v
  /// of all its points.
  [[nodiscard]] double seen_power(const Eigen::Ref<const Eigen::ArrayXf>& errors,
                                  const Eigen::Ref<const Eigen::ArrayXf>& variances) const;
  /// Returns the power mean over the materials, given the sum of their `seen_power`.
  [[nodiscard]] double power_mean(double sum) const;
  /// Adds to `sums`, for each candidate of a range, the `seen_power` of the family's materials after measurements at
  /// `cells` and at the candidate.
  void add_with_each(const excluded_family& some, std::span<const Eigen::Index> cells, block range,
                     std::vector<double>& sums) const;

  design::point_geometry geometry_;
  located_rows rows_;
  Eigen::VectorXd error_variances_;
  expected_covariance expected_;
  perceived_options options_;
  thread_count threads_;
  std::vector<excluded_family> families_;
  Eigen::ArrayXf weights_;       ///< one per point
  Eigen::MatrixXd discrepancy_;  ///< n x n
  std::vector<bool> allowed_;
  Eigen::Index materials_ = 0;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/evaluate/impl/perceived_candidates.ipp>
#endif
