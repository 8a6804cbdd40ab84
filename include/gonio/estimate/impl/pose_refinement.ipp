#pragma once
/// Bodies of estimate/pose_refinement.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/estimate/pose_refinement.hpp>
#include <gonio/solve/dense.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace gonio::detail {

/// Rotates a direction by a rotation vector (Rodrigues' formula).
[[nodiscard]] GONIO_INLINE direction turned_by(const direction& w, const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (!(angle > 0.0)) return w;
  const Eigen::Vector3d axis = turn / angle;
  const double cosine = std::cos(angle), along = (1.0 - cosine) * axis.dot(w);
  return cosine * w + along * axis + std::sin(angle) * cross_product(axis, w);
}

/// Returns a sample of an image after the rotations of light and camera. Returns it unchanged if light or camera would
/// then be below the horizon. If the values were divided by the cosine of the stated light (`by_irradiance`), divides
/// by the cosine of the rotated light instead.
[[nodiscard]] GONIO_INLINE sample turned_sample(const sample& s, const pose_correction& turns, bool by_irradiance) {
  const auto& [nominal_wi, nominal_wo] = s.directions.pair();
  const direction wi = turned_by(nominal_wi, turns.light), wo = turned_by(nominal_wo, turns.camera);
  if (!(wi.z() > 0.0 && wo.z() > 0.0)) return s;
  const double cosines = by_irradiance ? nominal_wi.z() / wi.z() : 1.0;
  return {direction_pair{wi, wo}, cosines * s.value, s.weight, s.aperture};
}

GONIO_INLINE pose_iteration::pose_iteration(std::vector<std::vector<sample_set>> materials,
                                            const pose_refinement_options& options, Eigen::Index components,
                                            Eigen::Index observations, const reader& read)
    : materials_(std::move(materials)), options_(options), components_(components), observations_(observations) {
  require_sensible();
  turns_.resize(materials_.front().size());
  state_ = at(turns_, read);
}

GONIO_INLINE void pose_iteration::require_sensible() const {
  if (!(options_.eta > 0.0 && std::isfinite(options_.eta)))
    refuse("eta must be positive and finite, not " + std::to_string(options_.eta));
  if (!(options_.deviation > 0.0 && options_.deviation < std::numbers::pi / 4.0))
    refuse("the deviation of light and camera must be from 0 to 45 degrees, not " +
           std::to_string(degrees(options_.deviation)));
  if (materials_.empty() || materials_.front().empty()) refuse("at least one image is needed");
  const Eigen::Index count = materials_.front().size();
  for (Eigen::Index m = 0; m < std::ssize(materials_); ++m)
    if (std::ssize(materials_[m]) != count)
      refuse({"material ", m + 1, " is in ", materials_[m].size(), " images, but material 1 in ", count});
  for (Eigen::Index p = 0; p < count; ++p) {
    sample_set all;
    for (const std::vector<sample_set>& images : materials_) all.insert(all.end(), images[p].begin(), images[p].end());
    require_usable(all);
  }
}

GONIO_INLINE sample pose_iteration::turned(const sample& s, const pose_correction& turns) const {
  return turned_sample(s, turns, options_.calibrated_by == light_calibration::irradiance);
}

GONIO_INLINE void pose_iteration::require_material(Eigen::Index material) const {
  if (material < 0 || material >= std::ssize(materials_))
    refuse({"there is no material ", material, " of ", materials_.size()});
}

GONIO_INLINE const Eigen::MatrixXd& pose_iteration::weights(Eigen::Index material) const {
  require_material(material);
  return state_.fits[material].weights;
}

GONIO_INLINE sample_set pose_iteration::samples(Eigen::Index material) const {
  require_material(material);
  const std::vector<sample_set>& images = materials_[material];
  sample_set all;
  for (Eigen::Index p = 0; p < std::ssize(images); ++p)
    for (const sample& s : images[p]) all.push_back(turned(s, turns_[p]));
  return all;
}

GONIO_INLINE void pose_iteration::step(const reader& read) {
  const Eigen::VectorXd whole = newton_step(read);
  for (double length = 1.0; length > 0.01; length /= 2.0) {
    const std::vector<pose_correction> tried = moved(length * whole);
    state candidate = at(tried, read);
    if (!(candidate.objective < state_.objective)) continue;
    converged_ = state_.objective - candidate.objective < 1e-6 * state_.objective;
    state_ = std::move(candidate);
    turns_ = tried;
    return;
  }
  converged_ = true;
}

GONIO_INLINE void pose_iteration::solve(const reader& read) {
  for (int i = 0; i < options_.iterations && !converged_; ++i) step(read);
}

GONIO_INLINE void pose_iteration::add_image(const sample_set& samples, const pose_correction& turns, const reader& read,
                                            Eigen::Index begin, equations& out) const {
  for_each_index(
      samples.size(), 64,
      [&](Eigen::Index i) {
        const Eigen::Index at = begin + i;
        const sample seen = turned(samples[i], turns);
        const double root = std::sqrt(seen.weight.mean());  // the channels share their equations
        rgb right;
        auto column = out.columns.col(at);
        read(seen.angles(), seen.value, column.transpose(), right);
        column *= root;
        for (Eigen::Index c = 0; c < 3; ++c) out.right(at, c) = root * right[c];
      },
      options_.threads);
}

GONIO_INLINE pose_iteration::fit pose_iteration::fit_of(const std::vector<sample_set>& images,
                                                        const std::vector<pose_correction>& turns,
                                                        const reader& read) const {
  Eigen::Index n = 0;
  for (const sample_set& samples : images) n += std::ssize(samples);
  fit found{equations(components_, n), {}, {}, 0.0};
  Eigen::Index begin = 0;
  for (Eigen::Index p = 0; p < std::ssize(images); ++p) {
    add_image(images[p], turns[p], read, begin, found.system);
    begin += std::ssize(images[p]);
  }
  const equations& system = found.system;
  found.normal = product_with_transpose(system.columns);
  for (Eigen::Index k = 0; k < components_; ++k) found.normal(k, k) += options_.eta;
  found.weights = cholesky(found.normal).solve(product(system.columns, system.right));
  const Eigen::MatrixXd explained = product(system.columns.transpose(), found.weights);
  for (Eigen::Index c = 0; c < 3; ++c)
    found.objective += (system.right.col(c) - explained.col(c)).dot(system.right.col(c)) / options_.eta;
  return found;
}

GONIO_INLINE pose_iteration::state pose_iteration::at(const std::vector<pose_correction>& turns,
                                                      const reader& read) const {
  state found;
  for (const std::vector<sample_set>& images : materials_) {
    found.fits.push_back(fit_of(images, turns, read));
    found.objective += found.fits.back().objective;
  }
  for (const pose_correction& t : turns)
    found.objective += turn_penalty() * (t.light.squaredNorm() + t.camera.squaredNorm());
  return found;
}

GONIO_INLINE double pose_iteration::turn_penalty() const {
  return 3.0 / (static_cast<double>(observations_) * options_.deviation * options_.deviation);
}

GONIO_INLINE std::vector<pose_correction> pose_iteration::moved(const Eigen::VectorXd& by) const {
  std::vector<pose_correction> turns = turns_;
  for (Eigen::Index p = 0; p < std::ssize(turns); ++p) {
    const Eigen::Index first = unknowns * p;
    turns[p].light += by.segment<3>(first);
    turns[p].camera += by.segment<3>(first + 3);
  }
  return turns;
}

/// Returns the derivative of an image's misfit y - Q c by one of its unknowns, by central differences. The step is the
/// expected rotation, because a smaller step would stay within a cell of the prior's grid.
GONIO_INLINE Eigen::MatrixXd pose_iteration::derivative(Eigen::Index material, Eigen::Index image_number,
                                                        Eigen::Index unknown, const reader& read) const {
  const sample_set& samples = materials_[material][image_number];
  const double width = options_.deviation / 2.0;
  const auto misfit_at = [&](double offset) {
    pose_correction turns = turns_[image_number];
    (unknown < 3 ? turns.light[unknown] : turns.camera[unknown - 3]) += offset;
    equations there(components_, std::ssize(samples));
    add_image(samples, turns, read, 0, there);
    there.right -= product(there.columns.transpose(), state_.fits[material].weights);
    return there.right;
  };
  Eigen::MatrixXd change = misfit_at(width);
  change -= misfit_at(-width);
  return change /= 2.0 * width;
}

/// Returns the derivatives of a material's misfits by all unknowns, with red, green and blue stacked: 3 n x unknowns.
GONIO_INLINE Eigen::MatrixXd pose_iteration::jacobian(Eigen::Index material, const reader& read) const {
  const std::vector<sample_set>& images = materials_[material];
  const Eigen::Index n = state_.fits[material].system.right.rows();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * n, unknowns * std::ssize(images));
  Eigen::Index begin = 0;
  for (Eigen::Index p = 0; p < std::ssize(images); ++p) {
    const auto count = std::ssize(images[p]);
    for (Eigen::Index u = 0; u < unknowns; ++u) {
      const Eigen::MatrixXd change = derivative(material, p, u, read);
      auto column = all.col(unknowns * p + u);
      for (Eigen::Index c = 0; c < 3; ++c) column.segment(c * n + begin, count) = change.col(c);
    }
    begin += count;
  }
  return all;
}

GONIO_INLINE void pose_iteration::add_curvature(Eigen::Index material, const reader& read, Eigen::MatrixXd& hessian,
                                                Eigen::MatrixXd& gradient) const {
  const fit& here = state_.fits[material];
  const Eigen::Index n = here.system.right.rows();
  if (n == 0) return;
  const Eigen::MatrixXd changes = jacobian(material, read);
  const Eigen::MatrixXd rows = here.system.columns.transpose();
  const cholesky normal(here.normal);
  for (Eigen::Index c = 0; c < 3; ++c) {
    // (Q Q' + eta I)^-1 J, through the k x k normal equations (Woodbury).
    const Eigen::MatrixXd own = changes.middleRows(c * n, n);
    Eigen::MatrixXd left = own - product(rows, normal.solve(product(here.system.columns, own)));
    left /= options_.eta;
    hessian += product(own.transpose(), left);
    gradient += product(left.transpose(), here.system.right.col(c));
  }
}

GONIO_INLINE Eigen::VectorXd pose_iteration::newton_step(const reader& read) const {
  const Eigen::Index all = unknowns * std::ssize(turns_);
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(all, all), gradient(all, 1);
  for (Eigen::Index i = 0; i < all; ++i) hessian(i, i) = turn_penalty();
  for (Eigen::Index p = 0; p < std::ssize(turns_); ++p)
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Eigen::Index first = unknowns * p;
      gradient(first + i, 0) = turn_penalty() * turns_[p].light[i];
      gradient(first + 3 + i, 0) = turn_penalty() * turns_[p].camera[i];
    }
  for (Eigen::Index m = 0; m < std::ssize(materials_); ++m) add_curvature(m, read, hessian, gradient);
  return -cholesky(hessian).solve(gradient);
}

}  // namespace gonio::detail
