#pragma once
/// Iterative solvers as objects that step, and the loop around them.

#include <gonio/solve/solver.hpp>

#include <concepts>
#include <string>

namespace gonio {

/// An iteration towards the optimum of one right-hand side. `run_to_convergence` is the loop around it; for convergence
/// plots, write your own loop.
///
/// Requirements that the compiler cannot check: except for rounding, a step does not raise the objective (primal
/// method) or does not lower it (dual method); `converged` is cheap.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/solve/nnls.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::row_matrix rows = gonio::row_matrix::Random(20, 3).cwiseAbs();
///   const gonio::least_squares_problem problem(rows, rows * Eigen::Vector3d(1, 0, 2));
///   const gonio::normal_equations& normal = problem.normal();
///   for (gonio::nnls::iteration run(normal, 0); !run.converged(); run.step())
///     std::printf("%g\n", normal.objective(run.result())[0]);
/// }
/// ```
/// With a model of your own, steepest descent:
/// ```cpp
/// #include <gonio/solve/iteration.hpp>
///
/// #include <cstdio>
///
/// class steepest_descent {
///  public:
///   explicit steepest_descent(const gonio::normal_equations& normal)
///       : gram_(normal.gram()), x_(Eigen::VectorXd::Zero(gram_.rows())), downhill_(normal.rhs().col(0)) {}
///
///   void step() {
///     const Eigen::VectorXd change = gram_ * downhill_;
///     const double length = downhill_.squaredNorm() / downhill_.dot(change);
///     x_ += length * downhill_;
///     downhill_ -= length * change;
///   }
///   bool converged() const { return downhill_.norm() < 1e-9; }
///   Eigen::VectorXd result() const { return x_; }
///
///  private:
///   Eigen::MatrixXd gram_;
///   Eigen::VectorXd x_, downhill_;
/// };
/// static_assert(gonio::solver_iteration<steepest_descent>);
///
/// int main() {
///   const gonio::row_matrix rows = gonio::row_matrix::Random(20, 3);
///   const gonio::least_squares_problem problem(rows, rows * Eigen::Vector3d(1, 0, 2));
///   steepest_descent run(problem.normal());
///   std::printf("%d steps\n", gonio::run_to_convergence(run, 1000, "steepest descent"));
/// }
/// ```
template <class Iteration>
concept solver_iteration = requires(Iteration& run, const Iteration& seen) {
  run.step();
  { seen.converged() } -> std::convertible_to<bool>;
  { seen.result() } -> std::convertible_to<Eigen::VectorXd>;
};

/// Steps until convergence and returns the number of steps. Throws gonio::error naming the `method` after `limit`
/// steps: an iteration that has not converged is never a result.
template <solver_iteration Iteration>
int run_to_convergence(Iteration& run, int limit, const std::string& method) {
  int steps = 0;
  for (; !run.converged(); run.step())
    if (++steps > limit)
      refuse({method, " has not converged after ", limit,
              " steps: the normal equations are inconsistent or too ill-conditioned"});
  return steps;
}

/// Returns a number of steps far above the needs of any problem with so many unknowns. An iteration that takes more
/// steps is cycling.
[[nodiscard]] inline int step_limit(Eigen::Index unknowns) { return static_cast<int>(10 * unknowns + 100); }

}  // namespace gonio
