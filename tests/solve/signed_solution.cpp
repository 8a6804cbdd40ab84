#include "../golden.hpp"
#include "../json.hpp"
#include "hard_problems_check.hpp"
#include <gonio/solve/row_active_set.hpp>
#include <gonio/solve/signed_solution.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

using gonio::least_squares_problem;
using gonio::normal_equations;
using gonio::sign_rule;
using hard_problems::family;

namespace {

random_problems::problem two_by_two(double c, double value) {
  random_problems::problem made{Eigen::MatrixXd(2, 2), Eigen::Vector2d(0.0, value)};
  made.matrix << 1, 0, c, c;
  return made;
}

/// The standard normal numbers of numpy's RandomState (Marsaglia's polar method), with which instances are published.
class numpy_normal {
 public:
  explicit numpy_normal(unsigned seed) : engine_(seed) {}

  double operator()() {
    if (const auto kept = std::exchange(kept_, std::nullopt)) return *kept;
    double x = 0.0, y = 0.0, squares = 0.0;
    do {
      x = 2.0 * uniform() - 1.0;
      y = 2.0 * uniform() - 1.0;
      squares = x * x + y * y;
    } while (squares >= 1.0 || squares == 0.0);
    const double stretch = std::sqrt(-2.0 * std::log(squares) / squares);
    kept_ = stretch * x;
    return stretch * y;
  }

 private:
  /// Combines two draws to 53 bits.
  double uniform() {
    const auto high = static_cast<double>(engine_() >> 5), low = static_cast<double>(engine_() >> 6);
    return (high * 67108864.0 + low) / 9007199254740992.0;
  }

  std::mt19937 engine_;
  std::optional<double> kept_;
};

/// Describes the first tally of a family that found an error.
std::string first_wrong(family what, unsigned from, unsigned to) {
  std::map<std::string, hard_problems::tally> tallies;
  for (unsigned seed = from; seed < to; ++seed) hard_problems::check(what, seed, tallies);
  for (const auto& [solver, sum] : tallies)
    if (sum.wrong > 0) return solver + ": " + sum.first_wrong;
  return "";
}

/// Checks from the rows that every NNLS method solves the problem.
void check_nnls(const random_problems::problem& problem, const least_squares_problem& given) {
  const auto nnls_ways = hard_problems::all_ways(given, 1.0).front();
  for (const hard_problems::way& each : nnls_ways) {
    CAPTURE(each.name);
    const gonio::solution found = each.solve(given);
    const auto by_rows = hard_problems::judge(problem, found.weights.col(0), 0.0, true);
    CHECK(found.report.kkt_residual[0] <= 1e-9);
    CHECK(by_rows.violation <= 1e-9);
    CHECK(found.weights.minCoeff() >= 0.0);
  }
}

}  // namespace

TEST_CASE("a weight that is zero at the optimum does not keep the other from its own") {
  const auto problem = two_by_two(392.0, 1.0);
  const normal_equations normal = problem.normal();
  const Eigen::Vector2d expected(0.0, 1.0 / 392.0);
  const auto right = [&](const gonio::solution& found) {
    return (found.weights.col(0) - expected).cwiseAbs().maxCoeff() <= 1e-15 && found.report.kkt_residual[0] <= 1e-9;
  };
  CHECK(right(gonio::nnls().solve(normal)));
  CHECK(right(gonio::nnls_block_pivoting().solve(normal)));
  CHECK(right(gonio::nnls_coordinate_descent().solve(normal)));
  CHECK(right(gonio::non_negative_lasso(0.0).solve(normal)));
  CHECK(right(gonio::lasso(0.0).solve(normal)));
  CHECK(right(gonio::quadratic_program<>().solve(normal)));
}

TEST_CASE("66,339 problems [1 0; c c]: none is wrong") {
  std::size_t wrong = 0;
  for (int c = 300; c <= 2000; ++c)
    for (int value = 1; value <= 39; ++value) {
      const normal_equations normal = two_by_two(c, value).normal();
      const double expected = static_cast<double>(value) / c;
      for (const auto& found : {gonio::nnls_coordinate_descent().solve(normal), gonio::lasso(0.0).solve(normal),
                                gonio::nnls_block_pivoting().solve(normal)})
        wrong += std::abs(found.weights(1, 0) - expected) <= 1e-13 * expected &&
                         std::abs(found.weights(0, 0)) <= 1e-9 * expected && found.report.kkt_residual[0] <= 1e-9
                     ? 0u
                     : 1u;
    }
  CHECK(wrong == 0u);
}

TEST_CASE("sixteen families of hard problems: every solver is right from the rows, or refuses") {
  for (int what = 0; what < hard_problems::families; ++what) {
    CAPTURE(hard_problems::names[static_cast<std::size_t>(what)]);
    CHECK(first_wrong(static_cast<family>(what), 0, 40) == "");
  }
}

TEST_CASE("the rows have digits that the normal equations have lost: Kahan's matrix of 40 columns") {
  const double angle = 1.2, cosine = std::cos(angle), sine = std::sin(angle);
  random_problems::problem problem{Eigen::MatrixXd::Zero(40, 40), Eigen::VectorXd(40)};
  for (Eigen::Index row = 0; row < 40; ++row) {
    const double scale = std::pow(sine, static_cast<double>(row));
    problem.matrix(row, row) = scale;
    for (Eigen::Index j = row + 1; j < 40; ++j) problem.matrix(row, j) = -cosine * scale;
    problem.right[row] = 1.0;
  }
  const least_squares_problem given = hard_problems::equations(problem);
  check_nnls(problem, given);
  const auto nnls_ways = hard_problems::all_ways(given, 1.0).front();
  for (const hard_problems::way& each : nnls_ways) {
    CAPTURE(each.name);
    CHECK(each.solve(given).report.residual[0] <= 1e-9 * problem.right.norm());
  }
}

TEST_CASE("a KKT residual of 1e-13 does not hide a column too many where weights are large") {
  CHECK(first_wrong(family::ill_conditioned, 4086, 4087) == "");
}

TEST_CASE("large weights are found in the rows, larger ones refused, and still larger ones are not wanted") {
  // The second column is the negative of the first, up to 1e-9, so reaching b needs weights of 1e9.
  random_problems::problem problem{Eigen::MatrixXd(2, 2), Eigen::Vector2d(0.0, 1.0)};
  problem.matrix << 1, -1, 0, 1e-9;
  const auto found = gonio::nnls().solve(hard_problems::equations(problem));
  CHECK(found.report.residual[0] <= 1e-6);
  CHECK(found.weights(0, 0) == doctest::Approx(1e9).epsilon(1e-6));
  problem.matrix(1, 1) = 3.5e-11;
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::nnls().solve(hard_problems::equations(problem))),
                       doctest::Contains("rounding them moves A x"), gonio::error);
  problem.matrix(1, 1) = 1e-11;  // smaller values count as dependent
  CHECK(gonio::nnls().solve(hard_problems::equations(problem)).weights.maxCoeff() <= 1.0);
}

TEST_CASE("normal equations are resolved where nothing hinges on their rounding") {
  const gonio::detail::signed_task nnls{sign_rule::non_negative, 0.0, "NNLS"}, free{sign_rule::any, 0.0, "lasso"},
      penalised{sign_rule::any, 0.1, "lasso"};
  const auto resolved = [](const random_problems::problem& problem, const Eigen::VectorXd& x, const auto& task) {
    return gonio::detail::is_resolved(problem.normal(), 0, x, task);
  };
  random_problems::problem problem{Eigen::MatrixXd(3, 2), Eigen::Vector3d(1, 0, 1)};
  problem.matrix << 1, 0, 0, 1, 0, 0;
  CHECK(resolved(problem, Eigen::Vector2d(1, 0), nnls));
  problem.matrix.col(1) = problem.matrix.col(0);  // equal columns: only signed weights can grow without limit
  CHECK(resolved(problem, Eigen::Vector2d(1, 0), nnls));
  CHECK_FALSE(resolved(problem, Eigen::Vector2d(1, 0), free));
  CHECK(resolved(problem, Eigen::Vector2d(0.9, 0), penalised));
  problem.matrix.col(1) *= -1.0;
  CHECK_FALSE(resolved(problem, Eigen::Vector2d(1, 0), nnls));
}

TEST_CASE("the rows alone: both signs, a penalty, columns that depend on each other") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    random_problems::generator random(seed);
    const auto problem = random.make(static_cast<random_problems::kind>(seed % random_problems::kinds));
    const normal_equations normal = problem.normal();
    const auto signs = seed % 2 == 0 ? sign_rule::any : sign_rule::non_negative;
    const double lambda = seed % 3 == 0 ? 0.0 : 0.01 * gonio::largest_lambda(normal, signs);
    gonio::row_active_set run(problem.matrix, problem.right, lambda, signs);
    gonio::run_to_convergence(run, gonio::step_limit(normal.unknowns()), "the rows");
    const auto found = hard_problems::judge(problem, run.result(), lambda, signs == sign_rule::non_negative);
    CHECK(found.violation <= 1e-12);
    CHECK(found.residual <= 1.0);
  }
}

TEST_CASE("all weight may be on a column of zeros") {
  Eigen::MatrixXd a(2, 2);
  a << 1, 0, -1, 0;
  const least_squares_problem problem(gonio::row_matrix(a), Eigen::MatrixXd::Zero(2, 1));
  const auto found = gonio::quadratic_program<gonio::convex_weights>().solve(problem);
  CHECK(found.weights.col(0).isApprox(Eigen::Vector2d(0, 1), 1e-12));
  CHECK(found.report.kkt_residual[0] <= 1e-9);
  const least_squares_problem nothing(gonio::row_matrix::Zero(3, 5), Eigen::MatrixXd::Ones(3, 1));
  CHECK(gonio::quadratic_program<gonio::convex_weights>().solve(nothing).weights.sum() == doctest::Approx(1.0));
}

TEST_CASE("numbers whose squares underflow are refused by name, and those above are not") {
  const auto problem = [](double column, double right) {
    gonio::row_matrix rows = gonio::row_matrix::Ones(3, 2);
    rows(0, 0) = 2.0;
    rows.col(1) *= column;
    return least_squares_problem(rows, Eigen::MatrixXd::Constant(3, 1, right));
  };
  CHECK_THROWS_WITH_AS(static_cast<void>(problem(1e-170, 1.0).normal()),
                       doctest::Contains("column 1 of a least-squares problem is too small"), gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(problem(1.0, 1e-170).normal()),
                       doctest::Contains("right-hand side 0 of a least-squares problem is too small"), gonio::error);
  CHECK(gonio::nnls().solve(problem(1e-120, 1e-120)).report.residual[0] <= 1e-130);
  CHECK(gonio::nnls().solve(problem(0.0, 0.0)).weights.isZero(0.0));
}

TEST_CASE("weights that are not finite violate the optimality conditions") {
  const normal_equations normal(Eigen::MatrixXd::Identity(2, 2), Eigen::MatrixXd::Ones(2, 1));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf}) {
    const Eigen::MatrixXd x = Eigen::Vector2d(1.0, bad);
    CHECK(gonio::kkt_violation(normal, x, 0.0, sign_rule::any)[0] == inf);
    CHECK(gonio::stationarity(normal, x)[0] == inf);
  }
}

TEST_CASE("fewer rows than columns, two of them zero: the instance of scipy's issue 22791") {
  random_problems::problem problem{Eigen::MatrixXd(5, 12), Eigen::VectorXd(5)};
  numpy_normal random(42);
  for (Eigen::Index row = 0; row < 5; ++row)
    for (Eigen::Index j = 0; j < 12; ++j) problem.matrix(row, j) = random();
  CHECK(problem.matrix(0, 0) == doctest::Approx(0.4967141530));
  problem.matrix.topRows(2).setZero();
  for (double& value : problem.right) value = random();
  check_nnls(problem, hard_problems::equations(problem));
}

TEST_CASE("the instances that are published with scipy's issues 20168, 20302 and 21021") {
  for (const auto& instance : golden_json("nnls_published.json")) {
    CAPTURE(instance["issue"].get<std::string>());
    const auto rows = instance["A"].get<std::vector<std::vector<double>>>();
    const auto right = instance["b"].get<std::vector<double>>();
    const auto n = std::ssize(rows), k = std::ssize(rows.front());
    random_problems::problem problem{Eigen::MatrixXd(n, k), Eigen::Map<const Eigen::VectorXd>(right.data(), n)};
    for (Eigen::Index row = 0; row < n; ++row)
      problem.matrix.row(row) = Eigen::Map<const Eigen::RowVectorXd>(rows[row].data(), k);
    check_nnls(problem, hard_problems::equations(problem));
  }
}
