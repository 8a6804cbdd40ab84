#pragma once
/// Least squares under linear constraints: Noell, Koehler and Stricker 2014, Eq. 10. Uses the dual active-set method of
/// Goldfarb and Idnani 1983 (doi:10.1007/BF02591962). If the Gram matrix is singular, runs that method for a sequence
/// of proximal points (Rockafellar, SIAM J. Control Optim. 14, 1976, doi:10.1137/0314056): the regularisation of
/// qpOASES (Ferreau et al., Math. Prog. Comp. 6, 2014, doi:10.1007/s12532-014-0071-1).

#include <gonio/solve/dual_active_set.hpp>
#include <gonio/solve/linear_constraints.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
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
  double kkt_residual = std::numeric_limits<double>::infinity();  ///< see `kkt_violation`
  int iterations = 0;                                             ///< number of constraints added or dropped
};

/// Solves one quadratic program for any of its right-hand sides.
class program_solver {
 public:
  using vector = Eigen::VectorXd;
  using iteration = dual_active_set;

  /// Keeps references. O(k^2).
  program_solver(const normal_equations& normal, const linear_constraints& constraints)
      : normal_(normal), constraints_(constraints), program_(normal, constraints) {}

  /// Starts from x = 0 under x >= 0, otherwise from the optimum without inequalities. Throws gonio::error if there is
  /// no solution (the constraints contradict each other, or the objective is unbounded), or if none is found.
  [[nodiscard]] program_optimum solve(Eigen::Index right_hand_side) const;

 private:
  static constexpr double good = 1e-11;        // KKT residual
  static constexpr double sufficient = 1e-10;  // KKT residual: proximal points approach some optima slowly
  static constexpr double largest_shift = 1e-9, smallest_shift = 1e-11;  // the diagonal of G is about 1
  static constexpr int patience = 20, proximal_limit = 200;              // points

  [[nodiscard]] int step_limit() const { return static_cast<int>(4 * (program_.unknowns() + program_.rows()) + 50); }

  static void advance(iteration& run, int limit) {
    for (int steps = 0; steps < limit && !run.converged(); ++steps) run.step();
  }

  /// Returns a start for x >= 0: all weights are zero, because far fewer than k of them usually become free.
  [[nodiscard]] active_constraints origin() const;

  [[nodiscard]] program_optimum judge(const iteration& run, const vector& q, Eigen::Index right_hand_side) const;

  /// Minimises the objective plus shift/2 |y - last y|^2 repeatedly, with decreasing shifts, until the last y is the
  /// optimum.
  [[nodiscard]] program_optimum solve_by_proximal_points(Eigen::Index right_hand_side, const vector& q,
                                                         active_constraints active, int changes) const;

  /// Returns true if weights are larger than a least-squares problem in double precision can explain. Also returns true
  /// if they are large and were accepted only because of their size: a KKT residual is relative to the gradient's
  /// terms, which grow with the weights.
  [[nodiscard]] bool is_suspicious(const program_optimum& found, const vector& y, const vector& q) const;

  /// Returns the proximal point or, if that is better, the point polished without the shift.
  [[nodiscard]] program_optimum best(const iteration& run, const vector& q, Eigen::Index right_hand_side) const;

  /// Returns true if the objective decreases without limit along a feasible direction, where its curvature is only a
  /// rounding error. (If m comes from equations, the slope is at most |b| times the square root of the curvature.)
  [[nodiscard]] bool falls_for_ever(const vector& movement, const vector& q, Eigen::Index right_hand_side) const;

  [[nodiscard]] static std::string falling(const vector& movement);

  const normal_equations& normal_;
  const linear_constraints& constraints_;
  scaled_program program_;
};

namespace detail {

/// Certifies the optima that `solve_program` found as a solution. Throws gonio::error if that fails.
[[nodiscard]] solution certified_program(const normal_equations& normal, const linear_constraints& constraints,
                                         solution found);

/// Certifies the solution of a problem with rows and computes its residual from the rows. If the normal equations are
/// not accurate enough, finds the solution again from the rows (`certified`) or, if there are constraint rows, throws
/// gonio::error.
[[nodiscard]] solution certified_program(const least_squares_problem& problem, const linear_constraints& constraints,
                                         solution found);

/// Solves a program for all right-hand sides: `solve_one(solver, column)` solves it for one.
template <quadratic_problem Problem, class SolveOne>
[[nodiscard]] solution solve_program(const Problem& problem, const linear_constraints& constraints,
                                     const SolveOne& solve_one) {
  const normal_equations& normal = problem.normal();
  const program_solver solver(normal, constraints);
  // If the problem has rows but there are no constraint rows, the rows give a second way to solve it.
  constexpr bool has_rows = std::same_as<Problem, least_squares_problem>;
  const bool second_chance = has_rows && constraints.d.size() == 0 && constraints.e.size() == 0;
  solution found;
  found.weights.resize(normal.unknowns(), normal.right_hand_sides());
  found.report.kkt_residual.resize(normal.right_hand_sides());
  for (Eigen::Index column = 0; column < normal.right_hand_sides(); ++column) {
    try {
      const program_optimum optimum = solve_one(solver, column);
      found.weights.col(column) = optimum.weights;
      found.report.kkt_residual[column] = optimum.kkt_residual;
      found.report.iterations += optimum.iterations;
    } catch (const error&) {
      if (!second_chance) throw;
      found.weights.col(column).setConstant(std::numeric_limits<double>::quiet_NaN());
      found.report.kkt_residual[column] = std::numeric_limits<double>::infinity();
    }
  }
  return certified_program(problem, constraints, std::move(found));
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
  using iteration = dual_active_set;

  quadratic_program() = default;
  explicit quadratic_program(Constraints constraints) : constraints_(std::move(constraints)) {}

  [[nodiscard]] const Constraints& constraints() const noexcept { return constraints_; }

  /// Throws gonio::error if the constraints do not fit the problem or contradict each other, if the objective is
  /// unbounded, or if the optimum is not found in a number of steps proportional to k and the constraint rows. If the
  /// normal equations of a problem with rows are not accurate enough, solves the problem from its rows
  /// (solve/signed_solution.hpp) or, if there are constraint rows, throws gonio::error.
  [[nodiscard]] solution solve(const least_squares_problem& problem) const { return solve_any(problem); }
  [[nodiscard]] solution solve(const normal_equations& normal) const { return solve_any(normal); }

 private:
  template <quadratic_problem Problem>
  [[nodiscard]] solution solve_any(const Problem& problem) const {
    const linear_constraints constraints = detail::constraints_for(constraints_, problem.normal().unknowns());
    return detail::solve_program(problem, constraints,
                                 [](const auto& solver, Eigen::Index column) { return solver.solve(column); });
  }

  Constraints constraints_;
};

static_assert(normal_solver<quadratic_program<>> && solves_non_negative<quadratic_program<>>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/quadratic_program.ipp>
#endif
