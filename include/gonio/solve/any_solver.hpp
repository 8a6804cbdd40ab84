#pragma once
/// A solver chosen at run time, for command lines and benchmarks. Programs that know theirs name it instead.

#include <gonio/solve/solver.hpp>

#include <functional>
#include <utility>

namespace gonio {

/// Holds any solver; copies of the held one are made as this is copied.
///
/// ```cpp
/// gonio::any_solver chosen = fast ? gonio::any_solver(gonio::nnls()) : gonio::any_solver(gonio::quadratic_program());
/// ```
class any_solver {
 public:
  template <solver Solver>
  requires(!std::same_as<Solver, any_solver>) any_solver(Solver held)
      : solve_([held = std::move(held)](const least_squares_problem& problem) { return held.solve(problem); }),
        non_negative_(solves_non_negative<Solver>) {}  // NOLINT: conversion is the point

  [[nodiscard]] solution solve(const least_squares_problem& problem) const { return solve_(problem); }

  /// Do all solutions of the one held have weights that are not negative? `solves_non_negative`, known at run time.
  [[nodiscard]] bool non_negative() const noexcept { return non_negative_; }

 private:
  std::function<solution(const least_squares_problem&)> solve_;
  bool non_negative_;
};

static_assert(solver<any_solver>);

}  // namespace gonio
