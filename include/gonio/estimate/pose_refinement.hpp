#pragma once
/// Finds the actual poses of light and camera of images, together with the BRDF. All samples of one image share its
/// pose error, so that neither averaging nor weights (`weighted_as_misplaced`) remove it.

#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace gonio {

/// The rotations of light and camera from their stated to their actual directions, about the centre of the sample. Each
/// is a vector along the rotation axis whose length is the angle in radians.
struct pose_correction {
  Eigen::Vector3d light = Eigen::Vector3d::Zero(), camera = Eigen::Vector3d::Zero();
};

/// How images were calibrated to reflectance. This decides how a displaced light changes their values.
enum class light_calibration {
  irradiance,  ///< divided by the irradiance on a surface that faces the light, and by the cosine of the stated light
  reference_in_place  ///< divided by a white reference at the sample's position: by the cosine of the actual light
};

/// Settings of the refinement.
struct pose_refinement_options {
  double eta = 40.0;                ///< Tikhonov's penalty on the weights
  double deviation = radians(0.5);  ///< of light and of camera: the expected root mean square angle of their rotations
  light_calibration calibrated_by = light_calibration::irradiance;
  int iterations = 20;  ///< largest number of steps
  thread_count threads = {};
};

namespace detail {

/// Everything in `pose_refinement` but the prior: the steps, with a function that reads the equations of an image.
class pose_iteration {
 public:
  /// The equations W^(1/2) (Q c - y) of some samples: rows of Q as columns, k x n, and right-hand sides, n x 3.
  struct equations {
    Eigen::MatrixXd columns, right;

    equations(Eigen::Index components, Eigen::Index samples) : columns(components, samples), right(samples, 3) {}
  };

  /// Writes the row of Q and the three values y of a sample with given angles and reflectance. Is called from several
  /// threads at once.
  using reader = std::function<void(const half_difference& angles, const rgb& value, Eigen::Ref<Eigen::RowVectorXd> row,
                                    rgb& right)>;

  /// For a prior of k components and m observations. `materials` has the samples of each image, for each material.
  /// Throws as `pose_refinement` does.
  pose_iteration(std::vector<std::vector<sample_set>> materials, const pose_refinement_options& options,
                 Eigen::Index components, Eigen::Index observations, const reader& read);

  [[nodiscard]] const std::vector<pose_correction>& turns() const noexcept { return turns_; }
  [[nodiscard]] double objective() const noexcept { return state_.objective; }
  [[nodiscard]] bool converged() const noexcept { return converged_; }
  [[nodiscard]] Eigen::Index materials() const noexcept { return materials_.size(); }
  [[nodiscard]] const Eigen::MatrixXd& weights(Eigen::Index material) const;
  [[nodiscard]] sample_set samples(Eigen::Index material) const;

  void step(const reader& read);
  void solve(const reader& read);

 private:
  static constexpr Eigen::Index unknowns = 6;  ///< per image

  /// The fit to one material's samples in all images.
  struct fit {
    equations system;
    Eigen::MatrixXd normal;   ///< Q'Q + eta I
    Eigen::MatrixXd weights;  ///< k x 3
    double objective = 0.0;   ///< without the penalty on the rotations
  };

  /// The fits of all materials, which share the rotations.
  struct state {
    std::vector<fit> fits;
    double objective = 0.0;
  };

  void require_sensible() const;
  void require_material(Eigen::Index material) const;
  [[nodiscard]] sample turned(const sample& s, const pose_correction& turns) const;
  /// Writes the equations of one image, from row `begin` on.
  void add_image(const sample_set& samples, const pose_correction& turns, const reader& read, Eigen::Index begin,
                 equations& out) const;
  [[nodiscard]] fit fit_of(const std::vector<sample_set>& images, const std::vector<pose_correction>& turns,
                           const reader& read) const;
  [[nodiscard]] state at(const std::vector<pose_correction>& turns, const reader& read) const;
  /// Returns the factor of |t|^2 in the objective divided by eta.
  [[nodiscard]] double turn_penalty() const;
  [[nodiscard]] std::vector<pose_correction> moved(const Eigen::VectorXd& by) const;
  [[nodiscard]] Eigen::MatrixXd derivative(Eigen::Index material, Eigen::Index image_number, Eigen::Index unknown,
                                           const reader& read) const;
  [[nodiscard]] Eigen::MatrixXd jacobian(Eigen::Index material, const reader& read) const;
  /// Adds one material's part of the normal equations of a step.
  void add_curvature(Eigen::Index material, const reader& read, Eigen::MatrixXd& hessian,
                     Eigen::MatrixXd& gradient) const;
  [[nodiscard]] Eigen::VectorXd newton_step(const reader& read) const;

  std::vector<std::vector<sample_set>> materials_;  ///< for each material, the samples of every image
  pose_refinement_options options_;
  Eigen::Index components_, observations_;
  std::vector<pose_correction> turns_;
  state state_;
  bool converged_ = false;
};

}  // namespace detail

/// Finds rotations t of light and camera, and weights c of a prior with m observations, that together minimise
///
///   sum over samples and channels of w |y(t) - Q(t) c|^2 + eta |c|^2 + (eta / m) 3 |t|^2 / deviation^2,
///
/// These are the most probable ones if every sample's error has the variance eta / m, as the penalty implies. The
/// mapped values y, minus the prior's mean, and the prior's rows Q depend on t through the directions. y also depends
/// on t through the light's cosine by which it was divided. For given rotations the weights are Tikhonov's, and the
/// minimum is F(t) = eta y'(Q Q' + eta I)^-1 y. Gauss-Newton steps on F find the rotations (variable projection with
/// Kaufman's derivative, BIT 15, 1975, doi:10.1007/BF01932995); a step is halved until F decreases. O(n k^2 + k^3) a
/// step.
///
/// Several materials in the same images share light and camera. The sum is then over all materials, each with its own
/// weights c, and a single t.
///
/// ```cpp
/// gonio::pose_refinement refinement(prior, images, {.deviation = gonio::radians(0.5)});
/// refinement.solve();
/// const auto paint = refinement.result();
/// ```
template <error_metric Metric>
class pose_refinement {
 public:
  /// Throws gonio::error unless eta and deviation are positive, every image has a sample, and all samples are finite
  /// and above the horizon with weights that are not negative.
  pose_refinement(pca<Metric> prior, std::vector<sample_set> images, const pose_refinement_options& options = {})
      : pose_refinement(std::move(prior), std::vector<std::vector<sample_set>>{std::move(images)}, options) {}

  /// Refines the poses of images with several materials; `materials` has the samples of every image for each. An image
  /// may lack some materials but not all. Also throws gonio::error unless all materials have the same number of images.
  pose_refinement(pca<Metric> prior, std::vector<std::vector<sample_set>> materials,
                  const pose_refinement_options& options = {})
      : prior_(std::move(prior)),
        iteration_(std::move(materials), options, prior_.size(), prior_.coefficients().rows(), reader()) {}

  [[nodiscard]] const std::vector<pose_correction>& turns() const noexcept { return iteration_.turns(); }
  /// Returns the minimised sum divided by eta.
  [[nodiscard]] double objective() const noexcept { return iteration_.objective(); }
  /// Returns true if the last step improved the objective by less than a millionth.
  [[nodiscard]] bool converged() const noexcept { return iteration_.converged(); }
  [[nodiscard]] Eigen::Index materials() const noexcept { return iteration_.materials(); }
  /// Returns the fit of a material. Throws gonio::error unless there is such a material.
  [[nodiscard]] fitted_brdf<pca<Metric>> result(Eigen::Index material = 0) const {
    return {prior_, iteration_.weights(material)};
  }

  /// Returns the samples of a material in their refined directions, with the values that they have there, for any
  /// estimator. Throws as `result` does.
  [[nodiscard]] sample_set samples(Eigen::Index material = 0) const { return iteration_.samples(material); }

  /// Makes one Gauss-Newton step.
  void step() { iteration_.step(reader()); }
  /// Makes steps until convergence, at most `pose_refinement_options::iterations`.
  void solve() { iteration_.solve(reader()); }

 private:
  [[nodiscard]] detail::pose_iteration::reader reader() const {
    return [this](const half_difference& angles, const rgb& value, Eigen::Ref<Eigen::RowVectorXd> row, rgb& right) {
      const location here = locate(prior_.cells(), angles);
      const double mean = offset_at(prior_, here);
      read_row_at(prior_, here, row);
      for (Eigen::Index c = 0; c < 3; ++c) right[c] = prior_.metric().forward(value[c], here) - mean;
    };
  }

  pca<Metric> prior_;
  detail::pose_iteration iteration_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/pose_refinement.ipp>
#endif
