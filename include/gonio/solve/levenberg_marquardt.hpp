#pragma once
/// Non-linear least squares of a few unknowns within bounds, on normal equations: J. J. More, "The Levenberg-Marquardt
/// Algorithm: Implementation and Theory", 1978 (doi:10.1007/BFb0067700), with the steps held within the box.

#include <gonio/core/assertion.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace gonio {

/// A function at a point, and the parabola that is taken for it there. Of 1/2 |r|^2 these are J'r and J'J.
struct local_parabola {
  double value = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;  ///< symmetric and positive semidefinite
};

/// Bounds of each unknown. Where both are equal it is held fixed.
struct unknown_bounds {
  Eigen::VectorXd lowest, highest;
};

struct levenberg_marquardt_options {
  Eigen::Index iteration_limit = 200;
  /// Ends where no unknown moves by more than this share of itself, or of 1 if it is smaller.
  double smallest_step = 1e-12;
  /// Ends where the parabola promises less than this share of the value.
  double smallest_gain = 1e-15;
  /// Smaller differences of values are rounding: ends where the parabola promises less.
  double resolution = 0.0;
};

/// Where the descent ended.
struct local_minimum {
  Eigen::VectorXd unknowns;
  double value = 0.0;
  Eigen::Index evaluations = 0;
  bool converged = false;  ///< false: the limit of iterations came first
  /// The KKT residual: by how much the parabola still falls within the bounds, as a share of the value at the start.
  double promised_gain = 0.0;
};

namespace detail {

/// Minimises g's + s'Hs / 2 over steps that stay within the bounds, approximately: an unknown whose step leaves the
/// box is held at its border, and the others are solved for again. O(n^4) at worst.
[[nodiscard]] Eigen::VectorXd bounded_step(const Eigen::VectorXd& gradient, const Eigen::MatrixXd& hessian,
                                           const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest);

}  // namespace detail

/// Descends from a start, which is first moved into the bounds. `function(unknowns)` returns a `local_parabola`; every
/// evaluation is asked for it. O(n^3) beside an evaluation.
///
/// ```cpp
/// const auto found = gonio::levenberg_marquardt(f, start, {lowest, highest});
/// ```
template <class Function>
[[nodiscard]] local_minimum levenberg_marquardt(Function&& function, const Eigen::VectorXd& start,
                                                const unknown_bounds& bounds,
                                                const levenberg_marquardt_options& options = {}) {
  GONIO_ASSERT(start.size() == bounds.lowest.size() && start.size() == bounds.highest.size());
  // Prepare the step of the damped parabola (H + damping diag H) s = -g within the bounds, and the gain that it
  // promises.
  const auto within = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return x.cwiseMax(bounds.lowest).cwiseMin(bounds.highest);
  };
  const auto step_from = [&](const Eigen::VectorXd& x, const local_parabola& here, double damping) -> Eigen::VectorXd {
    Eigen::MatrixXd damped = here.hessian;
    const Eigen::VectorXd diagonal = here.hessian.diagonal();
    const double least = std::max(1e-14 * diagonal.maxCoeff(), std::numeric_limits<double>::min());
    damped.diagonal() += damping * diagonal.cwiseMax(least) + Eigen::VectorXd::Constant(x.size(), least);
    return detail::bounded_step(here.gradient, damped, bounds.lowest - x, bounds.highest - x);
  };
  const auto gain_of = [](const local_parabola& here, const Eigen::VectorXd& step) {
    return -(here.gradient.dot(step) + 0.5 * step.dot(here.hessian * step));
  };

  // Start within the bounds.
  local_minimum found;
  found.unknowns = within(start);
  if (start.size() == 0) {
    found.value = function(found.unknowns).value;
    found.evaluations = 1;
    found.converged = true;
    return found;
  }
  local_parabola here = function(found.unknowns);
  found.evaluations = 1;
  const double scale = std::max(std::abs(here.value), std::numeric_limits<double>::min());
  double damping = 1e-3, bend = 1.0;
  constexpr double largest_damping = 1e12, least_bend = 0.05;
  for (Eigen::Index iteration = 0; iteration < options.iteration_limit && !found.converged; ++iteration) {
    // Step to the minimum of the damped parabola.
    local_parabola flatter = here;
    flatter.hessian *= bend;
    const Eigen::VectorXd step = step_from(found.unknowns, flatter, damping);
    if (!step.allFinite()) break;  // a start at which the function is no number
    const double promised = gain_of(flatter, step);
    // Stop where steps are tiny or promise no gain.
    const bool tiny = (step.array().abs() <= options.smallest_step * found.unknowns.array().abs().max(1.0)).all();
    const double least_gain = std::max(options.smallest_gain * here.value, options.resolution);
    if (tiny || promised <= least_gain || damping > largest_damping) {
      found.converged = true;
      break;
    }
    // Evaluate the candidate.
    const Eigen::VectorXd candidate = within(found.unknowns + step);
    local_parabola there = function(candidate);
    ++found.evaluations;
    // A comparison that a value which is no number fails.
    const bool better = there.value < here.value;
    const double change = there.value - here.value, kept = -change / promised;
    // Adapt the damping to the share of the promised gain that was kept.
    damping *= !better ? 8.0 : kept > 0.75 ? 0.1 : kept > 0.25 ? 1.0 : 3.0;
    damping = std::max(damping, 1e-15);
    if (!better) {
      bend = 1.0;
      continue;
    }
    // Guess the curvature from what the step has met: weighted squares that lie above a norm bend more than it does.
    const double met = 2.0 * (change - here.gradient.dot(step)) / step.dot(here.hessian * step);
    bend = std::isfinite(met) ? std::clamp(met, least_bend, 1.0) : 1.0;
    found.unknowns = candidate;
    here = std::move(there);
  }
  // Report the value, and the gain that an undamped step still promises.
  found.value = here.value;
  found.promised_gain = gain_of(here, step_from(found.unknowns, here, 0.0)) / scale;
  return found;
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/levenberg_marquardt.ipp>
#endif
