#pragma once
/// A solver chosen at run time, for command lines and benchmarks. If the solver is known, use its type instead.

#include <gonio/solve/solver.hpp>

#include <functional>
#include <utility>

namespace gonio {

/// Holds a copy of any solver.
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

  /// Returns true if the weights of the held solver are never negative: `solves_non_negative` at run time.
  [[nodiscard]] bool non_negative() const noexcept { return non_negative_; }

 private:
  std::function<solution(const least_squares_problem&)> solve_;
  bool non_negative_;
};

static_assert(solver<any_solver>);

}  // namespace gonio
