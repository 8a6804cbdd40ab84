#include "random_problems.hpp"
#include <gonio/solve/any_solver.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/quadratic_program.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <doctest/doctest.h>

using gonio::any_solver;

// The held solver is known only at run time.
static_assert(!gonio::solves_non_negative<any_solver>);

TEST_CASE("the solver held solves, and says whether its weights can be negative") {
  const gonio::least_squares_problem problem(random_matrix(9, 4, 1), random_matrix(9, 2, 2));
  any_solver chosen = gonio::nnls();
  CHECK(chosen.non_negative());
  CHECK(chosen.solve(problem).weights == gonio::nnls().solve(problem).weights);
  CHECK(any_solver(gonio::quadratic_program()).non_negative());
  CHECK_FALSE(any_solver(gonio::quadratic_program(gonio::linear_constraints{})).non_negative());
  chosen = gonio::tikhonov(0.5);
  const any_solver copy = chosen;
  CHECK_FALSE(copy.non_negative());
  CHECK(copy.solve(problem).weights == gonio::tikhonov(0.5).solve(problem).weights);
}
