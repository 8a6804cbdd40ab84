#pragma once
/// Iterative solvers as objects that step, and the one loop around them.

#include <gonio/solve/solver.hpp>

#include <concepts>
#include <string>

namespace gonio {

/// One right-hand side on its way to the optimum. Whoever wants convergence plots owns the loop:
/// ```cpp
/// for (gonio::nnls::iteration run(normal, 0); !run.converged(); run.step()) plot(normal.objective(run.result()));
/// ```
/// What the compiler cannot check: a step does not raise the objective (a primal method) or does not lower it (a dual
/// method) beyond rounding, and `converged` is cheap.
template <class Iteration>
concept solver_iteration = requires(Iteration& run, const Iteration& seen) {
  run.step();
  { seen.converged() } -> std::convertible_to<bool>;
  { seen.result() } -> std::convertible_to<Eigen::VectorXd>;
};

/// Steps until convergence and returns the number of steps. Throws gonio::error naming the `method` after `limit`
/// steps: an iteration that does not end is never an answer.
template <solver_iteration Iteration>
int run_to_convergence(Iteration& run, int limit, const std::string& method) {
  int steps = 0;
  for (; !run.converged(); run.step())
    if (++steps > limit)
      refuse({method, " has not converged after ", limit,
              " steps: the normal equations are inconsistent or too ill-conditioned"});
  return steps;
}

/// Steps that no problem of so many unknowns has needed by far: whoever takes more goes in circles.
[[nodiscard]] inline int step_limit(Eigen::Index unknowns) { return static_cast<int>(10 * unknowns + 100); }

}  // namespace gonio
