#pragma once
/// Bodies of solve/quadratic_program.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/dual_active_set.hpp>
#include <gonio/solve/linear_constraints.hpp>
#include <gonio/solve/quadratic_program.hpp>
#include <gonio/solve/signed_solution.hpp>
#include <gonio/solve/solver.hpp>
#include <gonio/solve/thin_product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE program_optimum program_solver::solve(Eigen::Index right_hand_side) const {
  const vector q = program_.rhs(normal_, right_hand_side);
  iteration run(program_, q, origin());
  advance(run, step_limit());
  if (run.converged() && !run.singular()) {
    program_optimum found = judge(run, q, right_hand_side);
    found.iterations = run.changes();
    const vector& y = run.scaled_weights();
    if (found.kkt_residual <= good && !is_suspicious(found, y, q)) return found;
    if (found.kkt_residual <= good && falls_for_ever(y, q, right_hand_side)) refuse(falling(y));
  }
  return solve_by_proximal_points(right_hand_side, q, run.active(), run.changes());
}

GONIO_INLINE active_constraints program_solver::origin() const {
  active_constraints start;
  if (program_.non_negative) start.bounds.assign(program_.unknowns(), true);
  return start;
}

GONIO_INLINE program_optimum program_solver::judge(const iteration& run, const vector& q,
                                                   Eigen::Index right_hand_side) const {
  program_optimum found;
  found.weights = run.result();
  if (program_.non_negative) found.weights = found.weights.cwiseMax(0.0);
  found.multipliers = run.multipliers();
  found.multipliers.inequality = found.multipliers.inequality.cwiseMax(0.0);
  const auto certify = [&](const vector& x) {
    return kkt_violation(normal_, right_hand_side, x, constraints_, found.multipliers);
  };
  found.kkt_residual = certify(found.weights);
  if (found.kkt_residual <= good) return found;
  // If the rows allow only zero, the weights are rounding errors. Relative to the weights, their violation of the rows
  // is large.
  const vector& y = run.scaled_weights();
  const double tiny = 1e-14 * (q.cwiseAbs().maxCoeff() + y.cwiseAbs().maxCoeff());
  const vector snapped = (y.array().abs() > tiny).select(found.weights, 0.0);
  const double kkt_residual = certify(snapped);
  if (kkt_residual < found.kkt_residual) {
    found.weights = snapped;
    found.kkt_residual = kkt_residual;
  }
  return found;
}

GONIO_INLINE program_optimum program_solver::solve_by_proximal_points(Eigen::Index right_hand_side, const vector& q,
                                                                      active_constraints active, int changes) const {
  vector y = vector::Zero(q.size());
  for (int point = 0; point < proximal_limit; ++point) {
    const double shift = std::max(smallest_shift, std::ldexp(largest_shift, -point));
    iteration run(program_, q + shift * y, active, shift);
    advance(run, 10 * step_limit());
    changes += run.changes();
    if (run.singular() || !run.converged()) break;
    const vector movement = run.scaled_weights() - y;
    if (falls_for_ever(movement, q, right_hand_side)) refuse(falling(movement));
    y = run.scaled_weights();
    active = run.active();
    program_optimum found = best(run, q, right_hand_side);
    found.iterations = changes;
    const bool settled = movement.cwiseAbs().maxCoeff() <= 1e-6 * y.cwiseAbs().maxCoeff();
    const double enough = settled ? good : point >= patience ? sufficient : 0.0;
    if (found.kkt_residual <= enough && !is_suspicious(found, y, q)) return found;
  }
  refuse({"a quadratic program has not been solved after ", changes,
          " changes of its active constraints: its Gram matrix is not positive semidefinite or too ill-conditioned"});
}

GONIO_INLINE bool program_solver::is_suspicious(const program_optimum& found, const vector& y, const vector& q) const {
  const double size = y.cwiseAbs().maxCoeff(), rhs = q.cwiseAbs().maxCoeff();
  const double given = program_.rows() > 0 ? std::max(rhs, program_.b.cwiseAbs().maxCoeff()) : rhs;
  return size > 1e11 * given || (size > 1e6 * given && found.kkt_residual * size > 1e-5 * rhs);
}

GONIO_INLINE program_optimum program_solver::best(const iteration& run, const vector& q,
                                                  Eigen::Index right_hand_side) const {
  program_optimum polished = judge(iteration::polished(run, q), q, right_hand_side);
  if (polished.kkt_residual <= good) return polished;
  program_optimum found = judge(run, q, right_hand_side);
  return found.kkt_residual < polished.kkt_residual ? found : polished;
}

GONIO_INLINE bool program_solver::falls_for_ever(const vector& movement, const vector& q,
                                                 Eigen::Index right_hand_side) const {
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
  const double curvature = std::max(0.0, way.dot(thin_product(program_.G, way).col(0))), slope = q.dot(way);
  if (curvature > epsilon * way.squaredNorm() || !(slope > 0.0)) return false;
  const double rounding = epsilon * way.cwiseAbs2().dot(program_.G.diagonal());
  const double reach = std::max(normal_.rhs_squared_norm()[right_hand_side], q.cwiseAbs2().maxCoeff());
  return slope * slope > 100.0 * reach * (curvature + rounding);
}

GONIO_INLINE std::string program_solver::falling(const vector& movement) {
  Eigen::Index column = 0;
  movement.cwiseAbs().maxCoeff(&column);
  return "the quadratic program is unbounded: its objective falls without limit in a direction that changes weight " +
         std::to_string(column);
}

}  // namespace gonio

namespace gonio::detail {

/// Certifies a solution with x >= 0 as the only constraint, or without constraints, by the conditions of NNLS.
template <quadratic_problem Problem>
[[nodiscard]] solution certified_signed_program(const Problem& problem, bool non_negative, solution found) {
  const sign_rule signs = non_negative ? sign_rule::non_negative : sign_rule::any;
  const int iterations = found.report.iterations;
  found = certified(problem, {signs, 0.0, "the quadratic program"}, std::move(found.weights));
  found.report.iterations = iterations;
  return found;
}

[[nodiscard]] inline bool has_constraint_rows(const linear_constraints& constraints) {
  return constraints.d.size() + constraints.e.size() > 0;
}

GONIO_INLINE solution certified_program(const normal_equations& normal, const linear_constraints& constraints,
                                        solution found) {
  if (!has_constraint_rows(constraints))
    return certified_signed_program(normal, constraints.non_negative, std::move(found));
  found.report.residual = normal.residual(found.weights);
  found.report.objective = normal.objective(found.weights);
  return found;
}

GONIO_INLINE solution certified_program(const least_squares_problem& problem, const linear_constraints& constraints,
                                        solution found) {
  if (!has_constraint_rows(constraints))
    return certified_signed_program(problem, constraints.non_negative, std::move(found));
  const normal_equations& normal = problem.normal();
  found = certified_program(normal, constraints, std::move(found));
  const Eigen::VectorXd by_normal = std::exchange(found.report.residual, problem.residual(found.weights));
  for (Eigen::Index column = 0; column < by_normal.size(); ++column) {
    const double rhs_squared_norm = normal.rhs_squared_norm()[column], residual = found.report.residual[column];
    if (std::abs(0.5 * (residual * residual - rhs_squared_norm) - found.report.objective[column]) >
        kkt_residual_limit * (residual * residual + rhs_squared_norm))
      refuse({"the quadratic program is too ill-conditioned for its normal equations: its residual is ", residual,
              " computed from the rows, but ", by_normal[column], " computed from the normal equations"});
  }
  return found;
}

}  // namespace gonio::detail
