#pragma once
/// Non-linear least squares of a few unknowns within bounds, by normal equations. The method is that of J. J. More,
/// "The Levenberg-Marquardt Algorithm: Implementation and Theory", 1978 (doi:10.1007/BFb0067700), with steps restricted
/// to the bounds.

#include <gonio/core/assertion.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace gonio {

/// The value of a function at a point, with the parabola that approximates the function near this point. For 1/2 |r|^2
/// with the Jacobian J of r, gradient and Hessian are J'r and J'J.
struct local_parabola {
  double value = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;  ///< symmetric and positive semidefinite
};

/// Bounds of each unknown. An unknown with equal bounds is fixed.
struct unknown_bounds {
  Eigen::VectorXd lowest, highest;
};

struct levenberg_marquardt_options {
  Eigen::Index iteration_limit = 200;
  /// The descent has converged if no unknown moves by more than this share of itself (or of 1 if it is smaller than 1).
  double smallest_step = 1e-12;
  /// The descent has converged if the parabola promises a gain below this share of the value.
  double smallest_gain = 1e-15;
  /// The descent has converged if the parabola promises a gain below this number, in units of the value: smaller
  /// differences are rounding.
  double resolution = 0.0;
};

/// The end point of the descent.
struct local_minimum {
  Eigen::VectorXd unknowns;
  double value = 0.0;
  Eigen::Index evaluations = 0;
  bool converged = false;  ///< false after the iteration limit, or if the function is not finite at the start
  /// The KKT residual: the gain that the parabola still promises within the bounds, as a share of the value at the
  /// start.
  double promised_gain = 0.0;
};

namespace detail {

/// Approximately minimises g's + s'Hs / 2 over steps s within the bounds, for the gradient g and the Hessian H: if the
/// step of an unknown leaves the bounds, holds this unknown at the bound and solves for the remaining unknowns again.
/// O(n^4) for n unknowns at worst.
[[nodiscard]] Eigen::VectorXd bounded_step(const Eigen::VectorXd& gradient, const Eigen::MatrixXd& hessian,
                                           const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest);

/// Returns the step from x to the minimum of the damped parabola, (H + damping diag H) s = -g, within the bounds.
[[nodiscard]] Eigen::VectorXd damped_parabola_step(const Eigen::VectorXd& x, const local_parabola& here, double damping,
                                                   const unknown_bounds& bounds);

/// Returns the decrease of a parabola along a step.
[[nodiscard]] double promised_gain(const local_parabola& here, const Eigen::VectorXd& step);

/// The damping and the curvature of the next parabola, adapted to the results of previous steps.
struct step_control {
  static constexpr double largest_damping = 1e12;

  double damping = 1e-3;
  double bend = 1.0;  ///< ratio of the observed curvature to that of the parabola

  /// Adapts damping and bend after a step that changed the value by `change` and was expected to lower it by
  /// `promised`.
  void learn(const local_parabola& here, const Eigen::VectorXd& step, double change, double promised);
};

}  // namespace detail

/// Minimises a function by descent from a start, which is first moved into the bounds. `function(unknowns)` returns a
/// `local_parabola` and is called once for each evaluation. A step costs O(n^3) for n unknowns in addition to an
/// evaluation.
///
/// ```cpp
/// const auto found = gonio::levenberg_marquardt(f, start, {lowest, highest});
/// ```
template <class Function>
[[nodiscard]] local_minimum levenberg_marquardt(Function&& function, const Eigen::VectorXd& start,
                                                const unknown_bounds& bounds,
                                                const levenberg_marquardt_options& options = {}) {
  GONIO_ASSERT(start.size() == bounds.lowest.size() && start.size() == bounds.highest.size());
  const auto within = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return x.cwiseMax(bounds.lowest).cwiseMin(bounds.highest);
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
  detail::step_control control;
  for (Eigen::Index iteration = 0; iteration < options.iteration_limit && !found.converged; ++iteration) {
    // Step to the minimum of the damped parabola.
    local_parabola flatter = here;
    flatter.hessian *= control.bend;
    const Eigen::VectorXd step = detail::damped_parabola_step(found.unknowns, flatter, control.damping, bounds);
    if (!step.allFinite()) break;  // the function is NaN at the start
    const double promised = detail::promised_gain(flatter, step);
    // Stop if the step is tiny or promises no gain.
    const bool tiny = (step.array().abs() <= options.smallest_step * found.unknowns.array().abs().max(1.0)).all();
    const double least_gain = std::max(options.smallest_gain * here.value, options.resolution);
    if (tiny || promised <= least_gain || control.damping > detail::step_control::largest_damping) {
      found.converged = true;
      break;
    }
    // Evaluate the candidate, and accept it if it is better.
    const Eigen::VectorXd candidate = within(found.unknowns + step);
    local_parabola there = function(candidate);
    ++found.evaluations;
    control.learn(here, step, there.value - here.value, promised);
    if (!(there.value < here.value)) continue;
    found.unknowns = candidate;
    here = std::move(there);
  }
  // Report the value, and the gain that an undamped step would promise.
  found.value = here.value;
  const Eigen::VectorXd undamped = detail::damped_parabola_step(found.unknowns, here, 0.0, bounds);
  found.promised_gain = detail::promised_gain(here, undamped) / scale;
  return found;
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/levenberg_marquardt.ipp>
#endif
