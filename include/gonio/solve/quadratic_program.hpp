#pragma once
/// Least squares under linear constraints: Noell, Koehler and Stricker 2014, Eq. 10, by the dual active-set method of
/// Goldfarb and Idnani 1983, and, where the Gram matrix is singular, by proximal points around it (Rockafellar, SIAM J.
/// Control Optim. 14, 1976), which is how qpOASES regularises (Ferreau et al., Math. Prog. Comp. 6, 2014).

#include <gonio/solve/dual_active_set.hpp>
#include <gonio/solve/linear_constraints.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// The optimum of a quadratic program for one right-hand side.
struct program_optimum {
  Eigen::VectorXd weights;
  constraint_multipliers multipliers;
  active_constraints active;
  double certificate = std::numeric_limits<double>::infinity();  ///< see `kkt_violation`
  int iterations = 0;                                            ///< constraints added or dropped
};

/// The solver of one quadratic program, for any of its right-hand sides. `Iteration` is as `dual_active_set`.
template <class Iteration = dual_active_set<>>
class program_solver {
 public:
  using vector = Eigen::VectorXd;

  /// Keeps references. O(k^2).
  program_solver(const normal_equations& normal, const linear_constraints& constraints)
      : normal_(normal), constraints_(constraints), program_(normal, constraints) {}

  /// From the active constraints `start`, or, if it is null, from x = 0 under x >= 0 and from the optimum without
  /// inequalities otherwise. Throws gonio::error if there is no solution, because the constraints contradict one
  /// another or the objective falls for ever, or if it is not found.
  [[nodiscard]] program_optimum solve(Eigen::Index right_hand_side, const active_constraints* start = nullptr) const {
    const vector q = program_.moment(normal_, right_hand_side);
    Iteration run(program_, q, start ? *start : origin());
    advance(run, step_limit());
    if (run.converged() && !run.singular()) {
      program_optimum found = judge(run, q, right_hand_side);
      found.iterations = run.changes();
      const vector& y = run.scaled_weights();
      if (found.certificate <= good && !is_suspicious(found, y, q)) return found;
      if (found.certificate <= good && falls_for_ever(y, q, right_hand_side)) throw error(falling(y));
    }
    return solve_by_proximal_points(right_hand_side, q, run.active(), run.changes());
  }

 private:
  static constexpr double good = 1e-11;        // certificate
  static constexpr double sufficient = 1e-10;  // of the proximal points, which approach some optima slowly
  static constexpr double largest_shift = 1e-9, smallest_shift = 1e-11;  // the diagonal of G is about 1
  static constexpr int patience = 20, proximal_limit = 200;              // points

  [[nodiscard]] int step_limit() const { return static_cast<int>(4 * (program_.unknowns() + program_.rows()) + 50); }

  static void advance(Iteration& run, int limit) {
    for (int steps = 0; steps < limit && !run.converged(); ++steps) run.step();
  }

  /// With x >= 0 all weights start at zero: far fewer than k become free, one after the other, as a rule.
  [[nodiscard]] active_constraints origin() const {
    active_constraints start;
    if (program_.non_negative) start.bounds.assign(static_cast<std::size_t>(program_.unknowns()), true);
    return start;
  }

  [[nodiscard]] program_optimum judge(const Iteration& run, const vector& q, Eigen::Index right_hand_side) const {
    program_optimum found;
    found.active = run.active();
    found.weights = run.weights();
    if (program_.non_negative) found.weights = found.weights.cwiseMax(0.0);
    found.multipliers = run.multipliers();
    found.multipliers.inequality = found.multipliers.inequality.cwiseMax(0.0);
    const auto certify = [&](const vector& x) {
      return kkt_violation(normal_, right_hand_side, x, constraints_, found.multipliers);
    };
    found.certificate = certify(found.weights);
    if (found.certificate <= good) return found;
    // Rows that leave only zero make weights of the size of rounding, which violate them completely.
    const vector& y = run.scaled_weights();
    const double tiny = 1e-14 * (q.cwiseAbs().maxCoeff() + y.cwiseAbs().maxCoeff());
    const vector snapped = (y.array().abs() > tiny).select(found.weights, 0.0);
    const double certificate = certify(snapped);
    if (certificate < found.certificate) {
      found.weights = snapped;
      found.certificate = certificate;
    }
    return found;
  }

  /// Minimises the objective plus shift/2 |y - last y|^2, with falling shifts, until the last y is the optimum.
  [[nodiscard]] program_optimum solve_by_proximal_points(Eigen::Index right_hand_side, const vector& q,
                                                         active_constraints active, int changes) const {
    vector y = vector::Zero(q.size());
    for (int point = 0; point < proximal_limit; ++point) {
      const double shift = std::max(smallest_shift, std::ldexp(largest_shift, -point));
      Iteration run(program_, q + shift * y, active, shift);
      advance(run, 10 * step_limit());
      changes += run.changes();
      if (run.singular() || !run.converged()) break;
      const vector movement = run.scaled_weights() - y;
      if (falls_for_ever(movement, q, right_hand_side)) throw error(falling(movement));
      y = run.scaled_weights();
      active = run.active();
      program_optimum found = best(run, q, right_hand_side);
      found.iterations = changes;
      const bool settled = movement.cwiseAbs().maxCoeff() <= 1e-6 * y.cwiseAbs().maxCoeff();
      const double enough = settled ? good : point >= patience ? sufficient : 0.0;
      if (found.certificate <= enough && !is_suspicious(found, y, q)) return found;
    }
    throw error(
        "a quadratic program has not been solved after " + std::to_string(changes) +
        " changes of its active constraints: its Gram matrix is not positive semidefinite or too ill-conditioned");
  }

  /// A certificate is relative to the gradient's terms, and weights that are large enough certify themselves. Are these
  /// larger than a least-squares problem in double precision can explain, or unexplained and not optimal without them?
  [[nodiscard]] bool is_suspicious(const program_optimum& found, const vector& y, const vector& q) const {
    const double size = y.cwiseAbs().maxCoeff(), moment = q.cwiseAbs().maxCoeff();
    const double given = program_.rows() > 0 ? std::max(moment, program_.b.cwiseAbs().maxCoeff()) : moment;
    return size > 1e11 * given || (size > 1e6 * given && found.certificate * size > 1e-5 * moment);
  }

  /// The proximal point, or what comes of it without the shift if that is good.
  [[nodiscard]] program_optimum best(const Iteration& run, const vector& q, Eigen::Index right_hand_side) const {
    program_optimum polished = judge(Iteration::polished(run, q), q, right_hand_side);
    if (polished.certificate <= good) return polished;
    program_optimum found = judge(run, q, right_hand_side);
    return found.certificate < polished.certificate ? found : polished;
  }

  /// Is this a feasible direction without end, along which the objective has no curvature beyond rounding and falls? A
  /// moment that comes from equations has at most |b| times the root of the curvature as its slope.
  [[nodiscard]] bool falls_for_ever(const vector& movement, const vector& q, Eigen::Index right_hand_side) const {
    constexpr double feasible = 1e-8;
    const double length = movement.cwiseAbs().maxCoeff();
    if (!(length > 0.0)) return false;
    const vector way = movement / length;
    if (program_.non_negative && way.minCoeff() < -feasible) return false;
    for (Eigen::Index i = 0; i < program_.rows(); ++i) {
      const double rate = program_.normals.col(i).dot(way);
      if (rate < -feasible || (i < program_.equalities && rate > feasible)) return false;
    }
    const double epsilon = 4.0 * static_cast<double>(q.size()) * std::numeric_limits<double>::epsilon();
    const double curvature = std::max(0.0, way.dot(program_.G * way)), slope = q.dot(way);
    if (curvature > epsilon * way.squaredNorm() || !(slope > 0.0)) return false;
    const double rounding = epsilon * way.cwiseAbs2().dot(program_.G.diagonal());
    const double reach = std::max(normal_.energy()[right_hand_side], q.cwiseAbs2().maxCoeff());
    return slope * slope > 100.0 * reach * (curvature + rounding);
  }

  [[nodiscard]] static std::string falling(const vector& movement) {
    Eigen::Index column = 0;
    movement.cwiseAbs().maxCoeff(&column);
    return "the quadratic program is unbounded: its objective falls for ever in a direction that moves weight " +
           std::to_string(column);
  }

  const normal_equations& normal_;
  const linear_constraints& constraints_;
  scaled_program<double> program_;
};

namespace detail {

/// Solves all right-hand sides by the solver's `solve_one(solver, column)`.
template <quadratic_problem Problem, class SolveOne>
[[nodiscard]] solution solve_program(const Problem& problem, const linear_constraints& constraints,
                                     const SolveOne& solve_one) {
  const normal_equations& normal = problem.normal();
  const program_solver<> solver(normal, constraints);
  solution found;
  found.weights.resize(normal.unknowns(), normal.right_hand_sides());
  found.certificate.resize(normal.right_hand_sides());
  for (Eigen::Index column = 0; column < normal.right_hand_sides(); ++column) {
    const program_optimum optimum = solve_one(solver, column);
    found.weights.col(column) = optimum.weights;
    found.certificate[column] = optimum.certificate;
    found.iterations += optimum.iterations;
  }
  found.residual = problem.residual(found.weights);
  found.objective = normal.objective(found.weights);
  return found;
}

template <constraint_policy Constraints>
[[nodiscard]] linear_constraints constraints_for(const Constraints& policy, Eigen::Index unknowns) {
  linear_constraints constraints = policy(unknowns);
  constraints.require_consistent(unknowns);
  if constexpr (promises_non_negative<Constraints>) constraints.non_negative = true;
  return constraints;
}

}  // namespace detail

/// Minimises |W^(1/2) (A x - b)|^2 under linear constraints, exactly. The Gram matrix may be singular.
///
/// ```cpp
/// const gonio::solution found = gonio::quadratic_program<gonio::convex_weights>().solve(problem);
/// const gonio::quadratic_program capped(gonio::linear_constraints{.D = D, .d = d, .non_negative = true});
/// ```
template <constraint_policy Constraints = non_negative_weights>
class quadratic_program {
 public:
  static constexpr bool non_negative = promises_non_negative<Constraints>;
  using iteration = dual_active_set<>;

  quadratic_program() = default;
  explicit quadratic_program(Constraints constraints) : constraints_(std::move(constraints)) {}

  [[nodiscard]] const Constraints& constraints() const noexcept { return constraints_; }

  /// Throws gonio::error if the constraints do not fit the problem, if they contradict one another, if the objective is
  /// unbounded, or if the optimum is not found within a number of steps that is proportional to k and the rows.
  template <quadratic_problem Problem = least_squares_problem>
  [[nodiscard]] solution solve(const Problem& problem) const {
    const linear_constraints constraints = detail::constraints_for(constraints_, problem.normal().unknowns());
    return detail::solve_program(problem, constraints,
                                 [](const auto& solver, Eigen::Index column) { return solver.solve(column); });
  }

 private:
  Constraints constraints_;
};

static_assert(normal_solver<quadratic_program<>> && solves_non_negative<quadratic_program<>>);

/// The same for a sequence of problems that differ little: each starts from the constraints that were active in the one
/// before, right-hand side by right-hand side. Not thread safe.
template <constraint_policy Constraints = non_negative_weights>
class online_quadratic_program {
 public:
  static constexpr bool non_negative = promises_non_negative<Constraints>;

  online_quadratic_program() = default;
  explicit online_quadratic_program(Constraints constraints) : constraints_(std::move(constraints)) {}

  /// As `quadratic_program::solve`, and with its results. A problem of another size starts afresh.
  template <quadratic_problem Problem = least_squares_problem>
  [[nodiscard]] solution solve(const Problem& problem) {
    const normal_equations& normal = problem.normal();
    const linear_constraints constraints = detail::constraints_for(constraints_, normal.unknowns());
    forget_unless_sized(normal, constraints);
    return detail::solve_program(problem, constraints, [&](const auto& solver, Eigen::Index column) {
      auto& last = active_[static_cast<std::size_t>(column)];
      const program_optimum found = solver.solve(column, last ? &*last : nullptr);
      last = found.active;
      return found;
    });
  }

  /// The next problem starts afresh.
  void forget() noexcept { active_.clear(); }

 private:
  void forget_unless_sized(const normal_equations& normal, const linear_constraints& constraints) {
    const auto bounds = static_cast<std::size_t>(normal.unknowns()),
               rows = static_cast<std::size_t>(constraints.d.size());
    if (!active_.empty() && active_.front() &&
        (active_.front()->bounds.size() != bounds || active_.front()->rows.size() != rows))
      active_.clear();
    active_.resize(static_cast<std::size_t>(normal.right_hand_sides()));
  }

  Constraints constraints_;
  std::vector<std::optional<active_constraints>> active_;
};

}  // namespace gonio
