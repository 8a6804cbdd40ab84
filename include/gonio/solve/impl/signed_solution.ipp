#pragma once
/// Bodies of solve/signed_solution.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/solve/growing_cholesky.hpp>
#include <gonio/solve/iteration.hpp>
#include <gonio/solve/kkt.hpp>
#include <gonio/solve/quadratic_program.hpp>
#include <gonio/solve/row_active_set.hpp>
#include <gonio/solve/row_equations.hpp>
#include <gonio/solve/signed_solution.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace gonio::detail {

/// If the KKT residual of weights is above this limit, they are computed in a second way.
inline constexpr double kkt_residual_sought = 1e-12;

/// The largest error of an objective, as a share of b'Wb / 2; and the largest change of A x by rounding the weights, as
/// a share of |b|.
inline constexpr double objective_tolerance = 1e-9, rounding_tolerance = 1e-5;

[[nodiscard]] inline double penalty_at(const solution& found, Eigen::Index column, double lambda) {
  return lambda * found.weights.col(column).cwiseAbs().sum();
}

[[nodiscard]] GONIO_INLINE solution evaluated(const normal_equations& normal, const signed_task& task,
                                              Eigen::MatrixXd weights) {
  solution found;
  found.weights = std::move(weights);
  found.report.residual = normal.residual(found.weights);
  found.report.objective = normal.objective(found.weights);
  for (Eigen::Index column = 0; column < found.weights.cols(); ++column)
    found.report.objective[column] += penalty_at(found, column, task.lambda);
  found.report.kkt_residual = kkt_violation(normal, found.weights, task.lambda, task.signs);
  return found;
}

/// Returns the sum of |a_j| |x_j| over the columns a_j of A: an upper bound of |A x|.
[[nodiscard]] GONIO_INLINE double reach_of(const normal_equations& normal, const Eigen::MatrixXd& weights,
                                           Eigen::Index column) {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < weights.rows(); ++j)
    sum += std::sqrt(normal.gram()(j, j)) * std::abs(weights(j, column));
  return sum;
}

/// Returns the reason why a solution fails the tests, or an empty string if it passes. `rounding` is the rounding error
/// of the objective.
[[nodiscard]] GONIO_INLINE std::string objection(const normal_equations& normal, const solution& found,
                                                 Eigen::Index column, double rounding, double limit) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  if (!(found.report.kkt_residual[column] <= limit)) return "the best weights found miss the optimality conditions";
  const double rhs_squared_norm = normal.rhs_squared_norm()[column],
               rhs = normal.rhs().col(column).cwiseAbs().maxCoeff();
  if (rhs_squared_norm == 0.0 && rhs > 0.0) return "";  // the normal equations were made without b'Wb
  const double half = 0.5 * rhs_squared_norm;
  if (!(epsilon * reach_of(normal, found.weights, column) <= rounding_tolerance * std::sqrt(rhs_squared_norm)))
    return "the weights are so large that rounding them moves A x by 1e-5 |b|";
  const double allowed = objective_tolerance * half + rounding;
  if (!(found.report.objective[column] <= allowed)) return "the best weights found fit worse than zero weights";
  if (!(found.report.objective[column] >= -half - allowed))
    return "the best weights found have a negative squared residual";
  return "";
}

[[nodiscard]] GONIO_INLINE error no_optimum(const signed_task& task, const std::string& why) {
  return error(message_of(
      {task.method, " has found no optimum: ", why, "; the columns are too ill-conditioned for double precision"}));
}

/// Returns the rounding error of an objective computed from normal equations, which is due to cancellation.
[[nodiscard]] GONIO_INLINE double rounding_of_objective(const normal_equations& normal, const solution& found,
                                                        Eigen::Index column) {
  const double reach = reach_of(normal, found.weights, column);
  return 4.0 * std::numeric_limits<double>::epsilon() * reach * reach;
}

/// Solves min 1/2 x'Q x - m'x + lambda |x|_1 as a quadratic program over x >= 0, or over u >= 0 and v >= 0 with x = u -
/// v.
[[nodiscard]] GONIO_INLINE Eigen::VectorXd optimum_by_program(const normal_equations& normal, Eigen::Index column,
                                                              const signed_task& task) {
  const Eigen::Index k = normal.unknowns(), parts = task.signs == sign_rule::any ? 2 : 1;
  Eigen::MatrixXd gram(parts * k, parts * k), rhs(parts * k, 1);
  for (Eigen::Index q = 0; q < parts; ++q)
    for (Eigen::Index j = 0; j < k; ++j) {
      const double sign = q == 0 ? 1.0 : -1.0;
      rhs(q * k + j, 0) = sign * normal.rhs()(j, column) - task.lambda;
      for (Eigen::Index p = 0; p < parts; ++p)
        for (Eigen::Index i = 0; i < k; ++i) gram(p * k + i, q * k + j) = (p == q ? 1.0 : -1.0) * normal.gram()(i, j);
    }
  const normal_equations program(std::move(gram), std::move(rhs), normal.rhs_squared_norm().segment(column, 1));
  const linear_constraints constraints{.non_negative = true};
  try {
    const Eigen::VectorXd found = program_solver(program, constraints).solve(0).weights;
    return parts == 1 ? found : Eigen::VectorXd(found.head(k) - found.tail(k));
  } catch (const error& refused) {
    throw no_optimum(task, refused.what());
  }
}

/// Copies weights and report of one right-hand side from one solution to another.
GONIO_INLINE void take(const solution& from, Eigen::Index column, solution& to) {
  to.weights.col(column) = from.weights.col(column);
  to.report.residual[column] = from.report.residual[column];
  to.report.objective[column] = from.report.objective[column];
  to.report.kkt_residual[column] = from.report.kkt_residual[column];
}

GONIO_INLINE solution certified(const normal_equations& normal, const signed_task& task, Eigen::MatrixXd weights) {
  solution found = evaluated(normal, task, std::move(weights));
  const auto objection_to = [&](const solution& given, Eigen::Index column, double limit) {
    return objection(normal, given, column, rounding_of_objective(normal, given, column), limit);
  };
  for (Eigen::Index column = 0; column < found.weights.cols(); ++column) {
    if (objection_to(found, column, kkt_residual_sought).empty()) continue;
    const bool good_enough = objection_to(found, column, kkt_residual_limit).empty();
    try {
      Eigen::MatrixXd again = found.weights;
      again.col(column) = optimum_by_program(normal, column, task);
      const solution other = evaluated(normal, task, std::move(again));
      const std::string why = objection_to(other, column, kkt_residual_limit);
      if (!why.empty()) throw no_optimum(task, why);
      if (!good_enough || other.report.kkt_residual[column] < found.report.kkt_residual[column])
        take(other, column, found);
    } catch (const error&) {
      if (!good_enough) throw;
    }
  }
  return found;
}

/// Returns true if the objective of the normal equations agrees with the residual of the rows.
[[nodiscard]] GONIO_INLINE bool rows_agree(const normal_equations& normal, const solution& found, Eigen::Index column,
                                           double lambda) {
  const double rhs_squared_norm = normal.rhs_squared_norm()[column], residual = found.report.residual[column];
  const double of_rows = 0.5 * (residual * residual - rhs_squared_norm) + penalty_at(found, column, lambda);
  return std::abs(of_rows - found.report.objective[column]) <= 0.5 * objective_tolerance * rhs_squared_norm;
}

/// Returns true if the objective is close to its optimum. The distance is at most `reach_of` the weights times the
/// error of the gradient, which is the KKT residual times |b| + reach.
[[nodiscard]] GONIO_INLINE bool gap_is_small(const normal_equations& normal, const solution& found,
                                             Eigen::Index column) {
  const double rhs_squared_norm = normal.rhs_squared_norm()[column], reach = reach_of(normal, found.weights, column);
  const double gap = found.report.kkt_residual[column] * (std::sqrt(rhs_squared_norm) + reach) * reach;
  return gap <= 0.5 * objective_tolerance * rhs_squared_norm;
}

GONIO_INLINE solution certified(const least_squares_problem& problem, const signed_task& task,
                                Eigen::MatrixXd weights) {
  const normal_equations& normal = problem.normal();
  solution found = evaluated(normal, task, std::move(weights));
  found.report.residual = problem.residual(found.weights);
  Eigen::MatrixXd triangle;
  std::vector<Eigen::Index> mended;
  for (Eigen::Index column = 0; column < found.weights.cols(); ++column) {
    if (objection(normal, found, column, 0.0, kkt_residual_sought).empty() && gap_is_small(normal, found, column) &&
        rows_agree(normal, found, column, task.lambda) && is_resolved(normal, column, found.weights.col(column), task))
      continue;
    // Start from zero, so that all solvers find the same weights.
    if (mended.empty()) triangle = triangular_equations(problem);
    row_active_set run(triangle.leftCols(normal.unknowns()), triangle.col(normal.unknowns() + column), task.lambda,
                       task.signs);
    run_to_convergence(run, step_limit(normal.unknowns()), task.method + " on the rows");
    found.weights.col(column) = run.result();
    mended.push_back(column);
  }
  if (mended.empty()) return found;
  found.report.residual = problem.residual(found.weights);
  const std::vector<scaled_gradient> gradients = gradients_of_rows(problem, found.weights);
  for (const Eigen::Index column : mended) {
    const double residual = found.report.residual[column];
    found.report.objective[column] =
        0.5 * (residual * residual - normal.rhs_squared_norm()[column]) + penalty_at(found, column, task.lambda);
    found.report.kkt_residual[column] =
        kkt_violation(gradients[column], &found.weights(0, column), task.lambda, task.signs);
    const std::string why = objection(normal, found, column, 0.0, kkt_residual_limit);
    if (!why.empty()) throw no_optimum(task, why);
  }
  return found;
}

GONIO_INLINE bool is_resolved(const normal_equations& normal, Eigen::Index right_hand_side,
                              const Eigen::VectorXd& weights, const signed_task& task) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  constexpr double undecided = 1e-9, least_pivot = 1e-13, tolerance = 1e-6;
  const Eigen::MatrixXd& gram = normal.gram();
  const double length = std::sqrt(normal.rhs_squared_norm()[right_hand_side]);
  const Eigen::VectorXd norms = gram.diagonal().cwiseSqrt();
  // Accept a penalty that bounds the weights: lambda |x|_1 is at most b'Wb / 2 at the optimum.
  if (task.lambda > 0.0) {
    const double largest = norms.maxCoeff() * length / (2.0 * task.lambda);
    if (epsilon * largest * largest <= 1e-10) return true;
  }
  // Collect the columns with a weight, and the columns whose gradient does not determine whether they have one.
  const scaled_gradient gradient = gradient_of(normal, right_hand_side, weights);
  std::vector<Eigen::Index> columns;
  for (Eigen::Index j = 0; j < weights.size(); ++j)
    if (weights[j] != 0.0) columns.push_back(j);
  for (Eigen::Index j = 0; j < weights.size(); ++j) {
    if (weights[j] != 0.0 || norms[j] == 0.0) continue;
    const double slope = task.signs == sign_rule::any ? std::abs(gradient.value[j]) : -gradient.value[j];
    if (slope - task.lambda / norms[j] >= -undecided * length) columns.push_back(j);
  }
  // Accept non-negative weights of columns at acute angles, which cannot cancel each other.
  if (task.signs == sign_rule::non_negative) {
    bool acute = true;
    for (const Eigen::Index i : columns)
      for (const Eigen::Index j : columns) acute = acute && gram(i, j) >= 0.0;
    if (acute) return true;
  }
  // Find the smallest pivot of these columns.
  growing_cholesky factor(std::ssize(columns));
  double least = 1.0;
  Eigen::VectorXd cross(std::ssize(columns));
  for (Eigen::Index size = 0; size < cross.size(); ++size) {
    const Eigen::Index j = columns[size];
    for (Eigen::Index i = 0; i < size; ++i) cross[i] = gram(columns[i], j);
    if (!factor.append(cross.head(size), gram(j, j))) return false;
    least = std::min(least, factor.pivot(size) / gram(j, j));
  }
  // Compare the rounding error with the length of the right-hand side.
  const double reach = norms.dot(weights.cwiseAbs());
  return least > least_pivot && epsilon * reach <= tolerance * std::sqrt(least) * length;
}

}  // namespace gonio::detail
