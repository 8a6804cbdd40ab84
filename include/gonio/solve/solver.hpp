#pragma once
/// The concept of a solver, and its result.

#include <gonio/solve/kkt.hpp>
#include <gonio/solve/least_squares_problem.hpp>

#include <Eigen/Core>

#include <concepts>
#include <span>
#include <string_view>
#include <utility>

namespace gonio {

/// The quality of the weights that a solver found, one entry for each right-hand side.
struct solve_report {
  Eigen::VectorXd residual;      ///< weighted norm of A x - b
  Eigen::VectorXd objective;     ///< 1/2 x'Q x - m'x (Noell et al. 2014, Eq. 10), plus the solver's own penalty
  Eigen::VectorXd kkt_residual;  ///< violation of the optimality (KKT) conditions of the solver's problem, see kkt.hpp
  int iterations = 0;            ///< sum over all right-hand sides; 0 for a direct solver
};

/// The result of a solver. Weights that no solver found have no report: store such weights as a matrix.
struct solution {
  Eigen::MatrixXd weights;  ///< k x r, one column for each right-hand side
  solve_report report;
};

/// Joins the solutions of several problems with the same unknowns: the right-hand sides of each problem follow those of
/// the problem before.
[[nodiscard]] solution concatenate_columns(std::span<const solution> parts);

/// Extends a solution in some of `unknowns` columns to all columns. The weights of all other columns are zero.
[[nodiscard]] solution scatter_columns(solution found, std::span<const Eigen::Index> columns, Eigen::Index unknowns);

/// Returns a solution of a problem's normal equations with the residual computed from the rows. Normal equations give
/// the residual only to half of the digits.
[[nodiscard]] solution with_residual_of_rows(solution found, const least_squares_problem& problem);

namespace detail {

/// The largest KKT residual that counts as success.
inline constexpr double kkt_residual_limit = 1e-9;

/// Returns the solution. Throws gonio::error naming the solver if a KKT residual is above `kkt_residual_limit`.
[[nodiscard]] solution require_certified(solution found, std::string_view solver);

}  // namespace detail

/// Finds the weights of a least-squares problem under the solver's own penalty or constraints.
///
/// Requirements that the compiler cannot check: the KKT residual is computed from the problem and the returned weights,
/// not from the solver's internal state, and is at most 1e-9 on success (`least_squares` documents an exception for
/// normal equations alone). A solver that does not reach it finds the optimum in another way or throws gonio::error.
/// Solving is const and thread safe.
///
/// A solver whose weights cannot be negative declares `static constexpr bool non_negative = true;`: such a solver makes
/// no sense for basis functions of arbitrary sign.
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
///   const gonio::solution found = gonio::nnls{}.solve(problem);
///   std::printf("%g, KKT residual %g\n", found.weights(2, 0), found.report.kkt_residual[0]);
/// }
/// ```
/// With a model of your own:
/// ```cpp
/// #include <gonio/solve/semidefinite.hpp>
/// #include <gonio/solve/solver.hpp>
///
/// #include <cstdio>
///
/// struct ordinary_least_squares {
///   gonio::solution solve(const gonio::least_squares_problem& problem) const {
///     const gonio::normal_equations& normal = problem.normal();
///     const Eigen::MatrixXd x = gonio::solve_semidefinite(normal.gram(), normal.rhs());
///     return {x, {problem.residual(x), normal.objective(x), gonio::stationarity(normal, x)}};
///   }
/// };
/// static_assert(gonio::solver<ordinary_least_squares>);
///
/// int main() {
///   const gonio::row_matrix rows = gonio::row_matrix::Random(20, 3);
///   const gonio::least_squares_problem problem(rows, rows * Eigen::Vector3d(1, 0, 2));
///   std::printf("%g\n", ordinary_least_squares{}.solve(problem).weights(2, 0));
/// }
/// ```
template <class Solver>
concept solver = requires(const Solver& candidate, const least_squares_problem& problem) {
  { candidate.solve(problem) } -> std::same_as<solution>;
};

/// A solver that only needs the normal equations. It solves subsets and leave-one-out problems without reading data.
template <class Solver>
concept normal_solver = solver<Solver> && requires(const Solver& candidate, const normal_equations& normal) {
  { candidate.solve(normal) } -> std::same_as<solution>;
};

/// True if the weights of a solver are never negative.
template <class Solver>
inline constexpr bool solves_non_negative = requires {
  requires bool(Solver::non_negative);
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/solver.ipp>
#endif
