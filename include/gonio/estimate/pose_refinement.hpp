#pragma once
/// Pictures whose light and camera are not quite where they are said to be: where they are, found together with the
/// BRDF. Samples of one picture are misplaced together, which no averaging takes away, and which weights
/// (`weighted_for_misplacement`) do not know.

#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/table/picture_samples.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// How far the directions of a picture are from where they are said to be: turns about the middle of the sample, as
/// vectors along their axes with the angles in radians as their lengths.
struct picture_turns {
  Eigen::Vector3d light = Eigen::Vector3d::Zero(), camera = Eigen::Vector3d::Zero();
};

/// What the refinement expects.
struct pose_refinement_options {
  double eta = 40.0;                ///< Tikhonov's penalty of the weights
  double deviation = radians(0.5);  ///< of light and of camera: the root mean square of the angle of their turns
  int iterations = 20;              ///< at most
  thread_count threads = {};
};

/// Turns t of light and camera, and weights c of a prior with m observations, that together minimise
///
///   sum over samples and channels of w |y(t) - Q(t) c|^2 + eta |c|^2 + (eta / m) 3 |t|^2 / deviation^2,
///
/// the most probable ones if every sample's error has the variance eta / m, which is what the penalty says. The mapped
/// values y, less the prior's mean, and its rows Q depend on t through the directions. For given turns the weights are
/// Tikhonov's and leave F(t) = eta y'(Q Q' + eta I)^-1 y; turns are found by Gauss and Newton's steps on F (variable
/// projection with Kaufman's derivative, BIT 15, 1975), shortened until they help. O(n k^2 + k^3) a step.
///
/// ```cpp
/// gonio::pose_refinement refinement(prior, pictures, {.deviation = gonio::radians(0.5)});
/// refinement.solve();
/// const auto paint = refinement.fit();
/// ```
template <error_metric Metric>
class pose_refinement {
 public:
  /// Throws gonio::error unless eta and deviation are positive and there is a sample in each picture, all of them above
  /// the horizon and finite, with weights that are not negative.
  pose_refinement(pca<Metric> prior, std::vector<picture_samples> pictures, const pose_refinement_options& options = {})
      : prior_(std::move(prior)), pictures_(std::move(pictures)), options_(options), turns_(pictures_.size()) {
    require_sensible();
    state_ = at(turns_);
  }

  [[nodiscard]] const std::vector<picture_turns>& turns() const noexcept { return turns_; }
  /// What is minimised, divided by eta.
  [[nodiscard]] double objective() const noexcept { return state_.objective; }
  /// Did the last step improve the objective by less than a millionth of it?
  [[nodiscard]] bool converged() const noexcept { return converged_; }
  [[nodiscard]] fitted_brdf<pca<Metric>> fit() const {
    solution found;
    found.weights = state_.weights;
    return {prior_, std::move(found)};
  }

  /// The samples where they were found to be, for any estimator.
  [[nodiscard]] sample_set samples() const {
    sample_set all;
    for (std::size_t p = 0; p < pictures_.size(); ++p) {
      const Eigen::Matrix3d light = rotation(turns_[p].light), camera = rotation(turns_[p].camera);
      for (const pair_sample& s : pictures_[p]) all.push_back({angles(s, light, camera), s.value, s.weight});
    }
    return all;
  }

  /// One step of Gauss and Newton.
  void step() {
    const Eigen::VectorXd whole = newton_step();
    for (double length = 1.0; length > 0.01; length /= 2.0) {
      const std::vector<picture_turns> tried = moved(length * whole);
      state candidate = at(tried);
      if (!(candidate.objective < state_.objective)) continue;
      converged_ = state_.objective - candidate.objective < 1e-6 * state_.objective;
      state_ = std::move(candidate);
      turns_ = tried;
      return;
    }
    converged_ = true;
  }

  void solve() {
    for (int i = 0; i < options_.iterations && !converged_; ++i) step();
  }

 private:
  static constexpr Eigen::Index unknowns = 6;  ///< of a picture

  /// All samples' equations W^(1/2) (Q c - y) for given turns.
  struct equations {
    row_matrix rows;
    Eigen::MatrixXd right;
  };

  struct state {
    equations system;
    Eigen::LLT<Eigen::MatrixXd> normal;  ///< of Q'Q + eta I
    Eigen::MatrixXd weights;             ///< k x 3
    double objective = 0.0;
  };

  void require_sensible() const {
    if (!(options_.eta > 0.0 && std::isfinite(options_.eta)))
      throw error("eta must be positive and finite, not " + std::to_string(options_.eta));
    if (!(options_.deviation > 0.0 && options_.deviation < std::numbers::pi / 4.0))
      throw error("light and camera may be off by 0 to 45 degrees, not by " +
                  std::to_string(degrees(options_.deviation)));
    if (pictures_.empty()) throw error("there is no picture");
    for (const picture_samples& picture : pictures_) require_usable(as_sample_set(picture));
  }

  [[nodiscard]] static Eigen::Matrix3d rotation(const Eigen::Vector3d& turn) {
    const double angle = turn.norm();
    if (!(angle > 0.0)) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  }

  /// Where one sample of a picture is after the turns; where that would be below the horizon, where it was.
  [[nodiscard]] static half_difference angles(const pair_sample& s, const Eigen::Matrix3d& light,
                                              const Eigen::Matrix3d& camera) {
    const direction wi = light * s.directions.wi, wo = camera * s.directions.wo;
    const bool above = wi.z() > 0.0 && wo.z() > 0.0;
    return above ? to_half_difference(wi, wo) : to_half_difference(s.directions.wi, s.directions.wo);
  }

  /// The equations of one picture from row `begin` on.
  void read(const picture_samples& picture, const picture_turns& turns, Eigen::Index begin, equations& out) const {
    const Eigen::Matrix3d light = rotation(turns.light), camera = rotation(turns.camera);
    for_each_block(
        picture.size(), 64,
        [&](block range) {
          for (std::size_t i = range.begin; i < range.end; ++i) {
            const location here = locate(prior_.cells(), angles(picture[i], light, camera));
            const auto row = begin + static_cast<Eigen::Index>(i);
            const double root = std::sqrt(picture[i].weight), mean = offset_at(prior_, here);
            read_row_at(prior_, here, out.rows.row(row));
            out.rows.row(row) *= root;
            for (Eigen::Index c = 0; c < 3; ++c)
              out.right(row, c) = root * (prior_.metric().forward(picture[i].value[c], here) - mean);
          }
        },
        options_.threads);
  }

  [[nodiscard]] state at(const std::vector<picture_turns>& turns) const {
    Eigen::Index n = 0;
    for (const picture_samples& picture : pictures_) n += std::ssize(picture);
    const auto k = static_cast<Eigen::Index>(prior_.size());
    state found{{row_matrix(n, k), Eigen::MatrixXd(n, 3)}, {}, {}, 0.0};
    Eigen::Index begin = 0;
    for (std::size_t p = 0; p < pictures_.size(); ++p) {
      read(pictures_[p], turns[p], begin, found.system);
      begin += std::ssize(pictures_[p]);
    }
    Eigen::MatrixXd normal = found.system.rows.transpose() * found.system.rows;
    normal.diagonal().array() += options_.eta;
    found.normal.compute(normal);
    found.weights = found.normal.solve(found.system.rows.transpose() * found.system.right);
    const Eigen::MatrixXd misfit = found.system.right - found.system.rows * found.weights;
    found.objective = misfit.cwiseProduct(found.system.right).sum() / options_.eta;
    for (const picture_turns& t : turns)
      found.objective += turn_penalty() * (t.light.squaredNorm() + t.camera.squaredNorm());
    return found;
  }

  /// Of |t|^2, where the objective is divided by eta.
  [[nodiscard]] double turn_penalty() const {
    const auto m = static_cast<double>(prior_.coefficients().rows());
    return 3.0 / (m * options_.deviation * options_.deviation);
  }

  /// (Q Q' + eta I)^-1 b, through the k x k normal equations (Woodbury).
  [[nodiscard]] Eigen::MatrixXd unexplained(const Eigen::MatrixXd& b) const {
    return (b - state_.system.rows * state_.normal.solve(state_.system.rows.transpose() * b)) / options_.eta;
  }

  [[nodiscard]] static Eigen::Vector<double, unknowns> as_vector(const picture_turns& turns) {
    Eigen::Vector<double, unknowns> both;
    both << turns.light, turns.camera;
    return both;
  }

  [[nodiscard]] std::vector<picture_turns> moved(const Eigen::VectorXd& by) const {
    std::vector<picture_turns> turns = turns_;
    for (std::size_t p = 0; p < turns.size(); ++p) {
      const auto step = by.segment<unknowns>(unknowns * static_cast<Eigen::Index>(p));
      turns[p].light += step.template head<3>();
      turns[p].camera += step.template tail<3>();
    }
    return turns;
  }

  /// How the misfit y - Q c of a picture changes with one of its unknowns, by central differences. They span what is
  /// expected of the turns: on the grid of the prior, smaller ones would see single cells.
  [[nodiscard]] Eigen::MatrixXd derivative(std::size_t picture, Eigen::Index unknown) const {
    const double width = options_.deviation / 2.0;
    const auto n = std::ssize(pictures_[picture]);
    const auto misfit_at = [&](double offset) {
      picture_turns turns = turns_[picture];
      (unknown < 3 ? turns.light[unknown] : turns.camera[unknown - 3]) += offset;
      equations there{row_matrix(n, state_.system.rows.cols()), Eigen::MatrixXd(n, 3)};
      read(pictures_[picture], turns, 0, there);
      return Eigen::MatrixXd(there.right - there.rows * state_.weights);
    };
    return (misfit_at(width) - misfit_at(-width)) / (2.0 * width);
  }

  [[nodiscard]] Eigen::VectorXd newton_step() const {
    const auto all = unknowns * std::ssize(pictures_);
    const Eigen::Index n = state_.system.rows.rows();
    std::array<Eigen::MatrixXd, 3> jacobian;
    jacobian.fill(Eigen::MatrixXd::Zero(n, all));
    Eigen::Index begin = 0;
    for (std::size_t p = 0; p < pictures_.size(); ++p) {
      const auto count = std::ssize(pictures_[p]);
      for (Eigen::Index u = 0; u < unknowns; ++u) {
        const Eigen::MatrixXd change = derivative(p, u);
        for (std::size_t c = 0; c < 3; ++c)
          jacobian[c].col(unknowns * static_cast<Eigen::Index>(p) + u).segment(begin, count) =
              change.col(static_cast<Eigen::Index>(c));
      }
      begin += count;
    }
    Eigen::MatrixXd hessian = turn_penalty() * Eigen::MatrixXd::Identity(all, all);
    Eigen::VectorXd gradient(all);
    for (std::size_t p = 0; p < pictures_.size(); ++p)
      gradient.segment<unknowns>(unknowns * static_cast<Eigen::Index>(p)) = turn_penalty() * as_vector(turns_[p]);
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::MatrixXd left = unexplained(jacobian[c]);
      hessian += jacobian[c].transpose() * left;
      gradient += left.transpose() * state_.system.right.col(static_cast<Eigen::Index>(c));
    }
    return -hessian.llt().solve(gradient);
  }

  pca<Metric> prior_;
  std::vector<picture_samples> pictures_;
  pose_refinement_options options_;
  std::vector<picture_turns> turns_;
  state state_;
  bool converged_ = false;
};

}  // namespace gonio
