#pragma once
/// Bodies of solve/levenberg_marquardt.hpp.

#include <gonio/core/assertion.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/solve/levenberg_marquardt.hpp>
#include <gonio/solve/semidefinite.hpp>
#include <gonio/solve/thin_product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace gonio::detail {

GONIO_INLINE Eigen::VectorXd bounded_step(const Eigen::VectorXd& gradient, const Eigen::MatrixXd& hessian,
                                          const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest) {
  const Eigen::Index n = gradient.size();
  // Hold each unknown that is at a bound, if descent would cross the bound.
  Eigen::VectorXd step = Eigen::VectorXd::Zero(n);
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool held = (lowest[i] >= 0.0 && gradient[i] >= 0.0) || (highest[i] <= 0.0 && gradient[i] <= 0.0);
    if (!held) free.push_back(i);
  }
  while (!free.empty()) {
    // Solve for the free unknowns: H_ff s = -(g + H s_held)_f.
    const Eigen::VectorXd change = thin_product(hessian, step);  // of the gradient, by the held unknowns
    const Eigen::Index count = std::ssize(free);
    Eigen::MatrixXd among(count, count);
    Eigen::VectorXd descent(count);
    for (Eigen::Index j = 0; j < count; ++j) {
      const Eigen::Index column = free[j];
      descent[j] = -(gradient[column] + change[column]);
      for (Eigen::Index i = 0; i < count; ++i) among(i, j) = hessian(free[i], column);
    }
    const Eigen::VectorXd moves = solve_semidefinite(among, descent);
    // If the step of an unknown leaves the bounds, hold the unknown at the bound.
    std::vector<Eigen::Index> inside;
    for (Eigen::Index j = 0; j < std::ssize(free); ++j) {
      const Eigen::Index i = free[j];
      const double move = moves[j];
      if (move < lowest[i] || move > highest[i])
        step[i] = std::clamp(move, lowest[i], highest[i]);
      else
        inside.push_back(i);
    }
    // Accept the step once all free unknowns are inside.
    if (inside.size() == free.size()) {
      for (Eigen::Index j = 0; j < std::ssize(free); ++j) step[free[j]] = moves[j];
      break;
    }
    free = std::move(inside);
  }
  return step;
}

GONIO_INLINE Eigen::VectorXd damped_parabola_step(const Eigen::VectorXd& x, const local_parabola& here, double damping,
                                                  const unknown_bounds& bounds) {
  Eigen::MatrixXd damped = here.hessian;
  const Eigen::VectorXd diagonal = here.hessian.diagonal();
  const double least = std::max(1e-14 * diagonal.maxCoeff(), std::numeric_limits<double>::min());
  damped.diagonal() += damping * diagonal.cwiseMax(least) + Eigen::VectorXd::Constant(x.size(), least);
  return bounded_step(here.gradient, damped, bounds.lowest - x, bounds.highest - x);
}

GONIO_INLINE double promised_gain(const local_parabola& here, const Eigen::VectorXd& step) {
  return -(here.gradient.dot(step) + 0.5 * step.dot(here.hessian * step));
}

GONIO_INLINE void step_control::learn(const local_parabola& here, const Eigen::VectorXd& step, double change,
                                      double promised) {
  // False for NaN.
  const bool better = change < 0.0;
  const double kept = -change / promised;
  // Adapt the damping to the ratio of the actual to the promised gain.
  damping *= !better ? 8.0 : kept > 0.75 ? 0.1 : kept > 0.25 ? 1.0 : 3.0;
  damping = std::max(damping, 1e-15);
  bend = 1.0;
  if (!better) return;
  // Estimate the curvature from the last step: weighted squares that bound another norm from above have more curvature
  // than this norm.
  constexpr double least_bend = 0.05;
  const double met = 2.0 * (change - here.gradient.dot(step)) / step.dot(here.hessian * step);
  if (std::isfinite(met)) bend = std::clamp(met, least_bend, 1.0);
}

}  // namespace gonio::detail
