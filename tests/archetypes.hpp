#pragma once
/// The smallest models of the library's concepts, as the concepts' documentation shows them. Every template is
/// instantiated with them: a concept checks signatures, not bodies.

#include <gonio/basis/basis.hpp>
#include <gonio/solve/semidefinite.hpp>
#include <gonio/solve/solver.hpp>

#include <span>

namespace archetype {

/// Depends on nothing.
struct identity_metric {
  double forward(double rho, const auto&) const noexcept { return rho; }
  double inverse(double y, const auto&) const noexcept { return y; }
};
static_assert(gonio::error_metric<identity_metric>);

/// The same, and its slope.
struct smooth_identity_metric : identity_metric {
  double slope(double) const noexcept { return 1.0; }
};
static_assert(gonio::smooth_metric<smooth_identity_metric>);

/// One function, the constant 1.
struct constant_basis {
  gonio::valid_cells over;
  double mean = 0.0;
  Eigen::Index size() const { return 1; }
  const gonio::valid_cells& cells() const { return over; }
  std::span<const float> row(Eigen::Index) const {
    static constexpr float one = 1;
    return {&one, 1};
  }
  double offset(Eigen::Index) const { return mean; }
  identity_metric metric() const { return {}; }
};
static_assert(gonio::tabulated_basis<constant_basis> && !gonio::computed_basis<constant_basis>);

/// A polynomial in theta_d: two functions that are computed wherever they are asked for.
struct theta_d_polynomial {
  gonio::valid_cells over;
  double mean = 0.0;
  Eigen::Index size() const { return 2; }
  const gonio::valid_cells& cells() const { return over; }
  void read_row(const gonio::location& at, gonio::function_row out) const { out << 1, at.angles.theta_d; }
  double offset(Eigen::Index) const { return mean; }
  identity_metric metric() const { return {}; }
};
static_assert(gonio::computed_basis<theta_d_polynomial> && !gonio::tabulated_basis<theta_d_polynomial>);

/// The normal equations as they are.
struct ordinary_least_squares {
  gonio::solution solve(const gonio::least_squares_problem& problem) const {
    const gonio::normal_equations& normal = problem.normal();
    const Eigen::MatrixXd x = gonio::solve_semidefinite(normal.gram(), normal.rhs());
    return {x, {problem.residual(x), normal.objective(x), gonio::stationarity(normal, x)}};
  }
};
static_assert(gonio::solver<ordinary_least_squares>);

}  // namespace archetype
