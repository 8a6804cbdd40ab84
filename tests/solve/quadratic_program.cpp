#include "../golden.hpp"
#include "../json.hpp"
#include "random_programs.hpp"
#include <gonio/solve/iteration.hpp>
#include <gonio/solve/quadratic_program.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

using gonio::convex_weights;
using gonio::dual_active_set;
using gonio::kkt_violation;
using gonio::linear_constraints;
using gonio::normal_equations;
using gonio::quadratic_program;
using gonio::sign_rule;

static_assert(gonio::normal_solver<quadratic_program<convex_weights>>);
static_assert(gonio::solves_non_negative<quadratic_program<convex_weights>>);
static_assert(!gonio::solves_non_negative<quadratic_program<linear_constraints>>);

using programs::extended;
using programs::matrix;
using programs::numbers;
using programs::random_constraints;
using programs::random_problem;
using programs::scaled;
using programs::times;
using programs::vector;

namespace {

bool near(const matrix& a, const matrix& b, double tolerance) {
  return (a - b).cwiseAbs().maxCoeff() <= tolerance * b.cwiseAbs().maxCoeff();
}

normal_equations identity_with(const vector& m) { return {matrix::Identity(m.size(), m.size()), m}; }

std::string refusal(const normal_equations& normal, const linear_constraints& constraints) {
  try {
    (void)quadratic_program(constraints).solve(normal);
  } catch (const gonio::error& e) {
    return e.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

normal_equations golden_equations(const nlohmann::json& instance) {
  const auto Q = instance["Q"].get<std::vector<std::vector<double>>>();
  const auto m = instance["c"].get<std::vector<double>>();  // A'b
  const Eigen::Index k = std::ssize(m);
  matrix gram(k, k);
  for (Eigen::Index j = 0; j < k; ++j) gram.col(j) = Eigen::Map<const vector>(Q[j].data(), k);
  return {gram, matrix(Eigen::Map<const vector>(m.data(), k))};
}

/// Checks a property for random seeds. The type of the property is erased, so that RapidCheck is compiled once.
bool for_all_seeds(const std::function<void(unsigned)>& property) { return rc::check(property); }

/// Random numbers derived from one seed.
struct draw {
  std::mt19937 generator;
  unsigned seed;
  explicit draw(unsigned from) : generator(from), seed(static_cast<unsigned>(generator()) >> 2) {}

  /// Returns a number of at least `from` and less than `to`.
  Eigen::Index number(Eigen::Index from, Eigen::Index to) { return from + generator() % (to - from); }
  bool coin() { return number(0, 2) == 1; }
  random_problem problem(Eigen::Index k) { return {k, static_cast<int>(number(0, random_problem::kinds)), seed}; }
};

/// Returns true if the solution is as good as the best of all active sets.
bool is_best(const gonio::solution& found, const random_problem& problem, const linear_constraints& constraints,
             const scaled& units) {
  const vector unscaled = units.by.cwiseProduct(found.weights.col(0));
  const double reached = objective(problem, extended(unscaled.begin(), unscaled.end()));
  const double best = lowest_objective(problem, constraints);
  return std::abs(reached - best) <= 1e-8 * std::max(std::abs(best), problem.scale());
}

}  // namespace

TEST_CASE("two unknowns, in closed form") {
  SUBCASE("x >= 0 projects") {
    const auto found = quadratic_program<>().solve(identity_with(numbers({3, -1})));
    CHECK(found.weights == numbers({3, 0}));
    CHECK(found.report.objective[0] == -4.5);
    CHECK(found.report.kkt_residual[0] == 0.0);
  }
  SUBCASE("the nearest point of x + y = 1") {
    const linear_constraints line{.E = matrix::Ones(1, 2), .e = vector::Ones(1)};
    const auto found = quadratic_program(line).solve(identity_with(numbers({2, 1})));
    CHECK(near(found.weights, numbers({1, 0}), 1e-14));
  }
  SUBCASE("the nearest point of the simplex") {
    const auto found = quadratic_program<convex_weights>().solve(identity_with(numbers({3, 1})));
    CHECK(found.weights == numbers({1, 0}));
  }
  SUBCASE("the nearest point of a half plane") {
    const linear_constraints half{.D = numbers({1, 2}).transpose(), .d = vector::Ones(1)};
    const auto found = quadratic_program(half).solve(identity_with(numbers({2, 2})));
    CHECK(near(found.weights, numbers({1, 0}), 1e-14));  // 5 / |(1, 2)|^2 along (1, 2)
    CHECK(quadratic_program(half).solve(identity_with(numbers({-1, 0}))).weights == numbers({-1, 0}));
  }
  SUBCASE("a line, a half plane and bounds at once") {
    const linear_constraints mixed{.D = numbers({1, 0, 0}).transpose(),
                                   .d = vector::Constant(1, 0.25),
                                   .E = matrix::Ones(1, 3),
                                   .e = vector::Ones(1),
                                   .non_negative = true};
    const auto found = quadratic_program(mixed).solve(identity_with(numbers({5, 2, -7})));
    CHECK(near(found.weights, numbers({0.25, 0.75, 0}), 1e-14));
    CHECK(found.report.kkt_residual[0] < 1e-14);
  }
}

TEST_CASE("several right-hand sides and data instead of normal equations") {
  const gonio::row_matrix A = random_matrix(9, 4, 1);
  const matrix b = random_matrix(9, 3, 2);
  const gonio::least_squares_problem problem(A, b);
  const auto found = quadratic_program<>().solve(problem);
  for (Eigen::Index column = 0; column < 3; ++column) {
    const auto alone = quadratic_program<>().solve(gonio::least_squares_problem(A, b.col(column)));
    CHECK(found.weights.col(column) == alone.weights);
    CHECK(found.report.residual[column] ==
          doctest::Approx((times(A, found.weights.col(column)) - b.col(column)).norm()));
    CHECK(found.report.kkt_residual[column] < 1e-14);
  }
  CHECK(found.report.kkt_residual ==
        kkt_violation(problem.normal(), found.weights, 0.0, sign_rule::non_negative).cwiseMax(0.0));
}

TEST_CASE("x >= 0 is the best of all supports") {
  CHECK(for_all_seeds([](unsigned seed) {
    draw any(seed);
    const auto problem = any.problem(any.number(2, 9));
    const scaled units(problem.m.size(), any.seed);
    const auto found = quadratic_program<>().solve(units.equations(problem));
    RC_ASSERT(found.report.kkt_residual[0] <= 1e-9);
    RC_ASSERT(found.weights.minCoeff() >= 0.0);
    // For condition numbers above 1e10, elimination no longer separates data from noise.
    RC_ASSERT(problem.decades > 5.0 || is_best(found, problem, {.non_negative = true}, units));
  }));
}

TEST_CASE("rows of both kinds, with and without bounds: the best of all active sets") {
  CHECK(for_all_seeds([](unsigned seed) {
    draw any(seed);
    const auto problem = any.problem(any.number(2, 6));
    const Eigen::Index k = problem.m.size(), equalities = any.number(0, std::min<Eigen::Index>(k, 3));
    const auto constraints = random_constraints(k, any.number(0, 4), equalities, any.coin(), any.seed + 50);
    const scaled units(k, any.seed);
    const auto found = quadratic_program(units.constraints(constraints)).solve(units.equations(problem));
    RC_ASSERT(found.report.kkt_residual[0] <= 1e-9);
    RC_ASSERT(problem.decades > 5.0 || is_best(found, problem, constraints, units));
  }));
}

TEST_CASE("larger problems are certified, whatever their rank, condition and scales") {
  CHECK(for_all_seeds([](unsigned seed) {
    draw any(seed);
    const auto problem = any.problem(any.number(10, 40));
    const Eigen::Index k = problem.m.size();
    const scaled units(k, any.seed);
    const normal_equations normal = units.equations(problem);
    const auto constraints = random_constraints(k, any.number(0, 12), any.number(0, 6), any.coin(), any.seed + 50);
    RC_ASSERT(quadratic_program(units.constraints(constraints)).solve(normal).report.kkt_residual[0] <= 1e-9);
    RC_ASSERT(
        quadratic_program<convex_weights>().solve(normal_equations(problem.Q, problem.m)).report.kkt_residual[0] <=
        1e-9);
    const auto found = quadratic_program<>().solve(normal);
    RC_ASSERT(found.report.kkt_residual[0] <= 1e-9);
    RC_ASSERT(kkt_violation(normal, found.weights, 0.0, sign_rule::non_negative)[0] <= 1e-9);
  }));
}

TEST_CASE("a linear program: no curvature at all") {
  // Maximises m'x over the simplex: the solution is the best corner.
  const matrix nothing = matrix::Zero(4, 4);
  const Eigen::Vector4d m(1, 7, -2, 3);
  const auto corner = quadratic_program<convex_weights>().solve(normal_equations(nothing, m));
  CHECK(near(corner.weights, numbers({0, 1, 0, 0}), 1e-12));
  CHECK(corner.report.kkt_residual[0] < 1e-10);
  // x1 + 2 x2 <= 4, 3 x1 + x2 <= 6: the corner (1.6, 1.2) for the gain (1, 1).
  linear_constraints polygon{.non_negative = true};
  polygon.D.resize(2, 2);
  polygon.D << 1, 2, 3, 1;
  polygon.d = numbers({4, 6});
  const auto best = quadratic_program(polygon).solve(normal_equations(matrix::Zero(2, 2), numbers({1, 1})));
  CHECK(near(best.weights, numbers({1.6, 1.2}), 1e-12));
}

TEST_CASE("redundant rows and a degenerate corner") {
  linear_constraints rows{.D = matrix::Ones(3, 2), .d = vector::Ones(3), .E = matrix::Ones(2, 2), .e = vector::Ones(2)};
  rows.non_negative = true;
  rows.D.row(2) << 1, 0;
  const auto found = quadratic_program(rows).solve(identity_with(numbers({4, 0})));
  CHECK(near(found.weights, numbers({1, 0}), 1e-14));
  // Only zero is feasible.
  const linear_constraints zero{.D = matrix::Ones(1, 2), .d = vector::Zero(1), .non_negative = true};
  CHECK(quadratic_program(zero).solve(identity_with(numbers({4, 1}))).weights == numbers({0, 0}));
}

TEST_CASE("a row that follows from two almost parallel ones is redundant") {
  // a, a + b / 2^20 and a + b, without rounding. The minimisers form a line along (1, 1, -2).
  const double tiny = std::ldexp(1.0, -20);
  linear_constraints rows{.E = matrix(3, 3), .e = numbers({6, 6 - tiny, 5})};
  rows.E << 1, 1, 1,  //
      1 + tiny, 1 - tiny, 1, 2, 0, 1;
  const auto found = quadratic_program(rows).solve(identity_with(numbers({2, 2, 2})));
  CHECK(near(found.weights, numbers({1.5, 2.5, 2}), 1e-8));
  CHECK(found.report.kkt_residual[0] < 1e-10);
}

TEST_CASE("a row's violation is relative to its bound, and its coefficients times the weights") {
  // At the optimum x = 2 of x^2 / 2 - 2 x, 3 x = 6 exceeds 4, by 2 / (4 + 3 * 2) relative to the terms.
  const auto violation = [](const linear_constraints& constraints) {
    return kkt_violation(identity_with(numbers({2})), 0, numbers({2}), constraints,
                         {vector::Zero(constraints.d.size()), vector::Zero(constraints.e.size())});
  };
  const matrix row = matrix::Constant(1, 1, 3.0);
  CHECK(violation({.D = row, .d = numbers({4})}) == doctest::Approx(0.2));
  CHECK(violation({.D = row, .d = numbers({8})}) == 0.0);
  CHECK(violation({.E = row, .e = numbers({4})}) == doctest::Approx(0.2));
  CHECK(violation({.E = row, .e = numbers({8})}) == doctest::Approx(2.0 / 14.0));
}

TEST_CASE("a row that overflows is violated without end") {
  const auto violation = [](const linear_constraints& constraints) {
    return kkt_violation(normal_equations(matrix::Zero(1, 1), matrix::Zero(1, 1)), 0, numbers({1e200}), constraints,
                         {vector::Zero(constraints.d.size()), vector::Zero(constraints.e.size())});
  };
  const matrix row = matrix::Constant(1, 1, 1e200);
  CHECK(std::isinf(violation({.D = row, .d = vector::Ones(1)})));
  CHECK(std::isinf(violation({.E = row, .e = vector::Ones(1)})));
}

TEST_CASE("constraints that contradict one another are refused") {
  const normal_equations normal = identity_with(numbers({1, 1}));
  linear_constraints gap{.D = matrix(2, 2), .d = numbers({0, -1})};  // x <= 0 and x >= 1
  gap.D << 1, 0, -1, 0;
  CHECK(contains(refusal(normal, gap), "contradict"));
  const linear_constraints two{.E = matrix::Ones(2, 2), .e = numbers({1, 2})};
  CHECK(contains(refusal(normal, two), "equality row 1"));
  const linear_constraints negative{.E = matrix::Ones(1, 2), .e = vector::Constant(1, -1), .non_negative = true};
  CHECK(contains(refusal(normal, negative), "contradict"));
  const linear_constraints nothing{.D = matrix::Zero(1, 2), .d = vector::Constant(1, -1)};
  CHECK(contains(refusal(normal, nothing), "contradict"));
  CHECK(contains(refusal(normal_equations(matrix::Zero(2, 2), numbers({1, 1})), gap), "contradict"));
  CHECK(for_all_seeds([](unsigned seed) {
    draw any(seed);
    const auto problem = any.problem(any.number(2, 12));
    auto rows = random_constraints(problem.m.size(), 4, 1, true, any.seed);
    rows.D.row(3) = -rows.D.row(0) - rows.D.row(1);
    rows.d[3] = -rows.d[0] - rows.d[1] - 0.5;
    const scaled units(problem.m.size(), any.seed);
    RC_ASSERT(contains(refusal(units.equations(problem), units.constraints(rows)), "contradict"));
  }));
}

TEST_CASE("an objective that falls for ever is refused") {
  const linear_constraints none{};
  const linear_constraints positive{.non_negative = true};
  matrix diagonal = matrix::Zero(2, 2);
  diagonal(0, 0) = 1.0;
  const normal_equations zero_column(diagonal, numbers({1, 1}));
  CHECK(contains(refusal(zero_column, none), "unbounded"));
  CHECK(contains(refusal(zero_column, positive), "unbounded"));
  // Downwards, zero is the bound.
  const auto bounded = quadratic_program<>().solve(normal_equations(diagonal, numbers({1, -1})));
  CHECK(bounded.weights == numbers({1, 0}));
  // x1 - x2 has no curvature and a gain.
  const normal_equations same(matrix::Ones(2, 2), numbers({1, 0.5}));
  CHECK(contains(refusal(same, none), "unbounded"));
  CHECK(near(quadratic_program<>().solve(same).weights, numbers({1, 0}), 1e-12));
  const linear_constraints capped{.D = numbers({1, 0}).transpose(), .d = vector::Constant(1, 3.0)};
  CHECK(quadratic_program(capped).solve(same).report.kkt_residual[0] < 1e-10);
  CHECK(for_all_seeds([](unsigned seed) {
    draw any(seed);
    // A ray in x > 0 without curvature and with a gain.
    const Eigen::Index k = any.number(2, 12), n = any.number(1, k + 3);
    const vector ray = random_matrix(k, 1, any.seed + 7).cwiseAbs() + vector::Constant(k, 0.1);
    matrix A = random_matrix(n, k, any.seed);
    A.col(k - 1).setZero();
    A.col(k - 1) = times(A, -ray) / ray[k - 1];
    const matrix Q = times(A.transpose(), A);
    const vector m = times(A.transpose(), random_matrix(n, 1, any.seed + 9)) + ray;
    const linear_constraints rows{
        .D = -random_matrix(2, k, seed).cwiseAbs(), .d = vector::Ones(2), .non_negative = true};
    RC_ASSERT(contains(refusal({Q, m}, rows), "unbounded"));
    RC_ASSERT(contains(refusal({Q, m}, {}), "unbounded"));
  }));
}

TEST_CASE("every start ends at the same optimum, and at once from the optimum's own active constraints") {
  const auto ends_at_the_optimum = [](unsigned seed) {
    draw any(seed);
    const Eigen::Index k = any.number(3, 30);
    const random_problem problem(k, 0, any.seed);
    const normal_equations normal(problem.Q, problem.m);
    const auto constraints = random_constraints(k, 5, 2, true, any.seed + 50);
    const gonio::scaled_program program(normal, constraints);
    const vector q = program.rhs(normal, 0);
    dual_active_set cold(program, q);
    gonio::run_to_convergence(cold, 1000, "the cold start");
    gonio::active_constraints start;
    for (Eigen::Index j = 0; j < k; ++j) start.bounds.push_back(any.coin());
    for (int i = 0; i < 5; ++i) start.rows.push_back(any.coin());
    dual_active_set arbitrary(program, q, start);
    gonio::run_to_convergence(arbitrary, 1000, "the arbitrary start");
    dual_active_set warm(program, q, cold.active());
    gonio::run_to_convergence(warm, 1000, "the warm start");
    RC_ASSERT(warm.changes() == 0);
    const double size = 1e-10 * (1.0 + cold.result().cwiseAbs().maxCoeff());
    RC_ASSERT((cold.result() - arbitrary.result()).cwiseAbs().maxCoeff() <= size);
    RC_ASSERT((cold.result() - warm.result()).cwiseAbs().maxCoeff() <= size);
    const auto optimum = gonio::program_solver(normal, constraints).solve(0);
    RC_ASSERT((cold.result() - optimum.weights).cwiseAbs().maxCoeff() <= size);
    RC_ASSERT(kkt_violation(normal, 0, optimum.weights, constraints, optimum.multipliers) <= 1e-10);
  };
  CHECK(for_all_seeds(ends_at_the_optimum));
  // The optimum is zero, so all violations are rounding errors.
  CHECK_NOTHROW(ends_at_the_optimum(266832711));
}

TEST_CASE("the objective of the dual method rises, up to the optimum") {
  const random_problem problem(20, 5, 3);
  const normal_equations normal(problem.Q, problem.m);
  const gonio::scaled_program program(normal, {.non_negative = true});
  dual_active_set run(program, program.rhs(normal, 0));
  int steps = 0;
  for (double last = normal.objective(run.result())[0]; !run.converged(); ++steps) {
    run.step();
    const double next = normal.objective(run.result())[0];
    CHECK(next > last);
    last = next;
  }
  CHECK(steps > 3);
}

TEST_CASE("the golden instances") {
  for (const auto& instance : golden_json("nnls.json")) {
    const normal_equations normal = golden_equations(instance);
    const auto x = instance["x"].get<std::vector<double>>();
    const Eigen::Map<const vector> expected(x.data(), std::ssize(x));
    const auto found = quadratic_program<>().solve(normal);
    CHECK(found.report.kkt_residual[0] < 1e-13);
    CHECK((found.weights - expected).cwiseAbs().maxCoeff() < 1e-8 * (1.0 + expected.cwiseAbs().maxCoeff()));
    CHECK(found.report.objective[0] == doctest::Approx(normal.objective(expected)[0]).epsilon(1e-10));
    CHECK(quadratic_program<convex_weights>().solve(normal).report.kkt_residual[0] < 1e-12);
  }
}

TEST_CASE("constraints that do not fit or are not finite are refused, naming the row") {
  const normal_equations normal = identity_with(numbers({1, 1}));
  CHECK(contains(refusal(normal, {.D = matrix::Ones(1, 3), .d = vector::Ones(1)}), "3 coefficients for 2 unknowns"));
  CHECK(contains(refusal(normal, {.D = matrix::Ones(2, 2), .d = vector::Ones(1)}), "2 rows"));
  CHECK(contains(refusal(normal, {.E = matrix::Ones(1, 2), .e = {}}), "equality"));
  linear_constraints bad{.D = matrix::Ones(3, 2), .d = vector::Ones(3)};
  bad.D(1, 1) = std::nan("");
  CHECK(contains(refusal(normal, bad), "row 1 of the inequality constraints is not finite in column 1"));
  linear_constraints infinite{.E = matrix::Ones(3, 2), .e = vector::Ones(3)};
  infinite.e[2] = INFINITY;
  CHECK(contains(refusal(normal, infinite), "row 2 of the equality constraints"));
}

TEST_CASE("a Gram matrix that is not positive semidefinite does not hang") {
  matrix indefinite(2, 2);
  indefinite << 1, 2, 2, 1;
  CHECK_THROWS_AS(quadratic_program<linear_constraints>().solve(normal_equations(indefinite, numbers({1, 1}))),
                  gonio::error);
}
