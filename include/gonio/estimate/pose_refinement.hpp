#pragma once
/// Images whose light and camera are not quite where they are said to be: where they are, found together with the
/// BRDF. Samples of one image are misplaced together, which no averaging takes away, and which weights
/// (`weighted_for_misplacement`) do not know.

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

/// How far the directions of an image are from where they are said to be: turns about the middle of the sample, as
/// vectors along their axes with the angles in radians as their lengths.
struct pose_correction {
  Eigen::Vector3d light = Eigen::Vector3d::Zero(), camera = Eigen::Vector3d::Zero();
};

/// How images were turned into reflectance, which says what a light that is off its place does to their values.
enum class light_calibration {
  irradiance,  ///< by the irradiance of a surface that faces the light, and the cosine of where the light should be
  reference_in_place  ///< by a white reference that lay where the sample lies: the cosine of where the light is
};

/// What the refinement expects.
struct pose_refinement_options {
  double eta = 40.0;                ///< Tikhonov's penalty of the weights
  double deviation = radians(0.5);  ///< of light and of camera: the root mean square of the angle of their turns
  light_calibration calibrated_by = light_calibration::irradiance;
  int iterations = 20;  ///< at most
  thread_count threads = {};
};

namespace detail {

/// All but the prior of `pose_refinement`: its steps, given whatever reads the equations of an image.
class pose_iteration {
 public:
  /// The equations W^(1/2) (Q c - y) of some samples: rows as columns, k x n, and right-hand sides, n x 3.
  struct equations {
    Eigen::MatrixXd columns, right;

    equations(Eigen::Index components, Eigen::Index samples) : columns(components, samples), right(samples, 3) {}
  };

  /// Writes the row of Q and the three values y of a sample, given its angles and reflectance; from several threads at
  /// once.
  using reader = std::function<void(const half_difference& angles, const rgb& value, Eigen::Ref<Eigen::RowVectorXd> row,
                                    rgb& right)>;

  /// A prior of k components and m observations; the samples of each image, for each material. Throws as
  /// `pose_refinement`.
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
  static constexpr Eigen::Index unknowns = 6;  ///< of an image

  /// What is fitted to a material's samples in all images.
  struct fit {
    equations system;
    Eigen::MatrixXd normal;   ///< Q'Q + eta I
    Eigen::MatrixXd weights;  ///< k x 3
    double objective = 0.0;   ///< without what the turns cost
  };

  /// All materials', which share the turns.
  struct state {
    std::vector<fit> fits;
    double objective = 0.0;
  };

  void require_sensible() const;
  void require_material(Eigen::Index material) const;
  [[nodiscard]] sample turned(const sample& s, const pose_correction& turns) const;
  /// The equations of one image from row `begin` on.
  void add_image(const sample_set& samples, const pose_correction& turns, const reader& read, Eigen::Index begin,
                 equations& out) const;
  [[nodiscard]] fit fit_of(const std::vector<sample_set>& images, const std::vector<pose_correction>& turns,
                           const reader& read) const;
  [[nodiscard]] state at(const std::vector<pose_correction>& turns, const reader& read) const;
  /// Of |t|^2, where the objective is divided by eta.
  [[nodiscard]] double turn_penalty() const;
  [[nodiscard]] std::vector<pose_correction> moved(const Eigen::VectorXd& by) const;
  [[nodiscard]] Eigen::MatrixXd derivative(Eigen::Index material, Eigen::Index image_number, Eigen::Index unknown,
                                           const reader& read) const;
  [[nodiscard]] Eigen::MatrixXd jacobian(Eigen::Index material, const reader& read) const;
  /// Adds a material's part of the normal equations of a step.
  void add_curvature(Eigen::Index material, const reader& read, Eigen::MatrixXd& hessian,
                     Eigen::MatrixXd& gradient) const;
  [[nodiscard]] Eigen::VectorXd newton_step(const reader& read) const;

  std::vector<std::vector<sample_set>> materials_;  ///< of each the samples of every image
  pose_refinement_options options_;
  Eigen::Index components_, observations_;
  std::vector<pose_correction> turns_;
  state state_;
  bool converged_ = false;
};

}  // namespace detail

/// Turns t of light and camera, and weights c of a prior with m observations, that together minimise
///
///   sum over samples and channels of w |y(t) - Q(t) c|^2 + eta |c|^2 + (eta / m) 3 |t|^2 / deviation^2,
///
/// the most probable ones if every sample's error has the variance eta / m, which is what the penalty says. The mapped
/// values y, less the prior's mean, and its rows Q depend on t through the directions, and y through the light's cosine
/// that was divided by. For given turns the weights are
/// Tikhonov's and leave F(t) = eta y'(Q Q' + eta I)^-1 y; turns are found by Gauss and Newton's steps on F (variable
/// projection with Kaufman's derivative, BIT 15, 1975, doi:10.1007/BF01932995), shortened until they help. O(n k^2 +
/// k^3) a step.
///
/// Several materials that are in the same images share light and camera: the sum then is over all of them, each with
/// its own weights c, and with one t.
///
/// ```cpp
/// gonio::pose_refinement refinement(prior, images, {.deviation = gonio::radians(0.5)});
/// refinement.solve();
/// const auto paint = refinement.result();
/// ```
template <error_metric Metric>
class pose_refinement {
 public:
  /// Throws gonio::error unless eta and deviation are positive and there is a sample in each image, all of them above
  /// the horizon and finite, with weights that are not negative.
  pose_refinement(pca<Metric> prior, std::vector<sample_set> images, const pose_refinement_options& options = {})
      : pose_refinement(std::move(prior), std::vector<std::vector<sample_set>>{std::move(images)}, options) {}

  /// The same of several materials, of each its samples in every image. An image may have none of a material; it
  /// must have some of one. Throws gonio::error unless all have as many images, too.
  pose_refinement(pca<Metric> prior, std::vector<std::vector<sample_set>> materials,
                  const pose_refinement_options& options = {})
      : prior_(std::move(prior)),
        iteration_(std::move(materials), options, prior_.size(), prior_.coefficients().rows(), reader()) {}

  [[nodiscard]] const std::vector<pose_correction>& turns() const noexcept { return iteration_.turns(); }
  /// What is minimised, divided by eta.
  [[nodiscard]] double objective() const noexcept { return iteration_.objective(); }
  /// Did the last step improve the objective by less than a millionth of it?
  [[nodiscard]] bool converged() const noexcept { return iteration_.converged(); }
  [[nodiscard]] Eigen::Index materials() const noexcept { return iteration_.materials(); }
  /// Throws gonio::error unless there is such a material.
  [[nodiscard]] fitted_brdf<pca<Metric>> result(Eigen::Index material = 0) const {
    return {prior_, iteration_.weights(material)};
  }

  /// The samples of a material where they were found to be, with the values that they have there, for any estimator.
  /// Throws as `result` does.
  [[nodiscard]] sample_set samples(Eigen::Index material = 0) const { return iteration_.samples(material); }

  /// One step of Gauss and Newton.
  void step() { iteration_.step(reader()); }
  /// Steps until it has converged, or as often as the options say.
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
