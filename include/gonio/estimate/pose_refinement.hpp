#pragma once
/// Finds the actual poses of light and camera for each image, together with the BRDF. All samples of an image share its
/// pose error, so neither averaging nor weights (`weighted_by_angular_error`) remove this error.

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

/// The rotations of light and camera about the centre of the sample, from their stated to their actual directions. Each
/// is a vector along the rotation axis whose length is the angle in radians.
struct pose_correction {
  Eigen::Vector3d light = Eigen::Vector3d::Zero(), camera = Eigen::Vector3d::Zero();
};

/// How images were calibrated to reflectance. The calibration determines how a displaced light changes the values.
enum class light_calibration {
  irradiance,  ///< divided by the irradiance on a surface that faces the light, and by the cosine of the stated light
  reference_in_place  ///< divided by the reading of a white reference at the sample's position, which contains the
                      ///< cosine of the actual light
};

struct pose_refinement_options {
  double eta = 40.0;                ///< Tikhonov's penalty on the weights
  double deviation = radians(0.5);  ///< expected root mean square angle of each rotation, in radians
  light_calibration calibrated_by = light_calibration::irradiance;
  int iterations = 20;  ///< largest number of steps
  thread_count threads = {};
};

namespace detail {

/// The steps of `pose_refinement`, independent of the metric. A function `read` returns the prior's equation of a
/// sample.
class pose_iteration {
 public:
  /// The equations W^(1/2) (Q c - y) of some samples: rows of Q as columns, k x n, and right-hand sides, n x 3.
  struct equations {
    Eigen::MatrixXd columns, right;

    equations(Eigen::Index components, Eigen::Index samples) : columns(components, samples), right(samples, 3) {}
  };

  /// Writes the row of Q and the three values y of a sample with given angles and reflectance. Several threads call it
  /// at once.
  using reader = std::function<void(const half_difference& angles, const rgb& value, Eigen::Ref<Eigen::RowVectorXd> row,
                                    rgb& right)>;

  /// Takes the samples of each image for each material (`materials`), and a prior of k components and m observations.
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

  /// The fit to the samples of one material in all images.
  struct fit {
    equations system;
    Eigen::MatrixXd normal;   ///< Q'Q + eta I
    Eigen::MatrixXd weights;  ///< k x 3
    double objective = 0.0;   ///< minimised sum, without the penalty on the rotations
  };

  /// The fits of all materials at the current rotations, which they share.
  struct state {
    std::vector<fit> fits;
    double objective = 0.0;
  };

  void require_sensible() const;
  void require_material(Eigen::Index material) const;
  [[nodiscard]] sample turned(const sample& s, const pose_correction& turns) const;
  /// Writes the equations of one image into `out`, starting with row `begin`.
  void add_image(const sample_set& samples, const pose_correction& turns, const reader& read, Eigen::Index begin,
                 equations& out) const;
  [[nodiscard]] fit fit_of(const std::vector<sample_set>& images, const std::vector<pose_correction>& turns,
                           const reader& read) const;
  [[nodiscard]] state at(const std::vector<pose_correction>& turns, const reader& read) const;
  /// Returns the factor of |t|^2 in the objective, which is the minimised sum divided by eta.
  [[nodiscard]] double turn_penalty() const;
  [[nodiscard]] std::vector<pose_correction> moved(const Eigen::VectorXd& by) const;
  [[nodiscard]] Eigen::MatrixXd derivative(Eigen::Index material, Eigen::Index image_number, Eigen::Index unknown,
                                           const reader& read) const;
  [[nodiscard]] Eigen::MatrixXd jacobian(Eigen::Index material, const reader& read) const;
  /// Adds the part of one material to the normal equations of a step.
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

/// Finds rotations t of light and camera of each image, and weights c of a prior with m observations, that together
/// minimise
///
///   sum over samples and channels of w |y(t) - Q(t) c|^2 + eta |c|^2 + (eta / m) 3 |t|^2 / deviation^2,
///
/// where w are the samples' weights and |t|^2 is summed over all images. These t and c are the most probable ones if
/// every sample's error has the variance eta / m, as the penalty implies. The prior's rows Q and the mapped values y,
/// minus the prior's mean, depend on t through the directions. With `light_calibration::irradiance`, y also depends on
/// t through the cosine of the light. For given rotations, c is Tikhonov's solution, and the first two terms are F(t) =
/// eta y'(Q Q' + eta I)^-1 y. Gauss-Newton steps find the rotations (variable projection with Kaufman's derivative, BIT
/// 15, 1975, doi:10.1007/BF01932995). Each step is halved until the whole sum decreases. O(n k^2 + k^3) a step for n
/// samples and k components.
///
/// If the same images show several materials, the sum is over all of them. Each material has its own weights c; all
/// share the rotations t.
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

  /// Refines the poses of images with several materials. `materials` has an entry for each material: its samples in
  /// every image. An image may lack some materials but not all. Throws gonio::error as for one material, and unless all
  /// materials have the same number of images.
  pose_refinement(pca<Metric> prior, std::vector<std::vector<sample_set>> materials,
                  const pose_refinement_options& options = {})
      : prior_(std::move(prior)),
        iteration_(std::move(materials), options, prior_.size(), prior_.coefficients().rows(), reader()) {}

  [[nodiscard]] const std::vector<pose_correction>& turns() const noexcept { return iteration_.turns(); }
  /// Returns the minimised sum divided by eta.
  [[nodiscard]] double objective() const noexcept { return iteration_.objective(); }
  /// Returns true if the last step improved the objective by less than a millionth of the objective, or not at all.
  [[nodiscard]] bool converged() const noexcept { return iteration_.converged(); }
  [[nodiscard]] Eigen::Index materials() const noexcept { return iteration_.materials(); }
  /// Returns the fit of a material. Throws gonio::error unless there is such a material.
  [[nodiscard]] fitted_brdf<pca<Metric>> result(Eigen::Index material = 0) const {
    return {prior_, iteration_.weights(material)};
  }

  /// Returns the samples of a material in their refined directions, with the values that belong to these directions.
  /// They can be passed to any estimator. Throws as `result` does.
  [[nodiscard]] sample_set samples(Eigen::Index material = 0) const { return iteration_.samples(material); }

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
