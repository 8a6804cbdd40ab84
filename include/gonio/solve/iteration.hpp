#pragma once
/// Iterative solvers as objects that step, and the one loop around them.

#include <gonio/solve/solver.hpp>

#include <concepts>
#include <string>

namespace gonio {

/// One right-hand side on its way to the optimum. Whoever wants convergence plots owns the loop:
/// ```cpp
/// for (gonio::nnls::iteration run(normal, 0); !run.converged(); run.step()) plot(normal.objective(run.weights()));
/// ```
/// What the compiler cannot check: a step does not raise the objective (a primal method) or does not lower it (a dual
/// method) beyond rounding, and `converged` is cheap.
template <class Iteration>
concept solver_iteration = requires(Iteration& run, const Iteration& seen) {
  run.step();
  { seen.converged() } -> std::convertible_to<bool>;
  { seen.weights() } -> std::convertible_to<Eigen::VectorXd>;
};

/// Steps until convergence and returns the number of steps. Throws gonio::error naming the `method` after `limit`
/// steps: an iteration that does not end is never an answer.
template <solver_iteration Iteration>
int run_to_convergence(Iteration& run, int limit, const std::string& method) {
  int steps = 0;
  for (; !run.converged(); run.step())
    if (++steps > limit)
      throw error(method + " has not converged after " + std::to_string(limit) +
                  " steps: the normal equations are inconsistent or too ill-conditioned");
  return steps;
}

/// Solves every right-hand side by the iteration that `start(column)` makes; fills all of the solution but its
/// objective and certificate.
template <quadratic_problem Problem, class Start>
[[nodiscard]] solution solve_by_iteration(const Problem& problem, int limit, const std::string& method, Start&& start) {
  const normal_equations& normal = problem.normal();
  solution found;
  found.weights.resize(normal.unknowns(), normal.right_hand_sides());
  for (Eigen::Index column = 0; column < normal.right_hand_sides(); ++column) {
    auto run = start(column);
    found.iterations += run_to_convergence(run, limit, method);
    found.weights.col(column) = run.weights();
  }
  found.residual = problem.residual(found.weights);
  return found;
}

}  // namespace gonio
