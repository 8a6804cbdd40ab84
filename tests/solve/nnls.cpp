#include "../dense_reference.hpp"
#include "../golden.hpp"
#include "../json.hpp"
#include "oracles/nnls_block_pivoting.hpp"
#include "oracles/nnls_coordinate_descent.hpp"
#include "random_problems.hpp"
#include <gonio/solve/lasso.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/quadratic_program.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::normal_equations;

namespace {

/// All four methods for NNLS, certified. The non-negative Lasso without a penalty is the same as coordinate descent;
/// the tests show that it is.
std::vector<std::pair<std::string, gonio::solution>> all_ways(const normal_equations& normal) {
  return {{"active set", gonio::nnls().solve(normal)},
          {"block principal pivoting", gonio::nnls_block_pivoting().solve(normal)},
          {"coordinate descent", gonio::nnls_coordinate_descent().solve(normal)},
          {"quadratic program", gonio::quadratic_program().solve(normal)},
          {"non-negative Lasso without a penalty", gonio::non_negative_lasso(0.0).solve(normal)}};
}

/// Returns the least objective of the feasible solutions on all supports of independent columns, one of which is the
/// optimum. For a few columns only.
double least_objective(const random_problems::problem& problem) {
  const Eigen::Index k = problem.matrix.cols();
  double least = 0.0;
  for (unsigned support = 1; support < 1u << k; ++support) {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index j = 0; j < k; ++j)
      if (support >> j & 1u) columns.push_back(j);
    const Eigen::MatrixXd part = problem.matrix(Eigen::all, columns);
    const auto x = dense_reference::least_squares(part, problem.right, 1e-10);
    if (!x || (x->array() < 0.0).any()) continue;
    // Computed from the rows: with nearly dependent columns the weights are large, and normal equations cancel.
    const Eigen::VectorXd off = part * *x - problem.right;
    least = std::min(least, 0.5 * (off.squaredNorm() - problem.right.squaredNorm()));
  }
  return least;
}

}  // namespace

TEST_CASE("2,200 random problems: all solvers satisfy the KKT conditions to 1e-9 and agree to 1e-8 in the objective") {
  double worst_kkt_residual = 0.0, worst_disagreement = 0.0;
  for (unsigned seed = 0; seed < 2200; ++seed) {
    random_problems::generator random(seed);
    const auto what = static_cast<random_problems::kind>(seed % random_problems::kinds);
    const auto problem = random.make(what);
    const normal_equations normal = problem.normal();
    const auto ways = all_ways(normal);
    const double scale = 0.5 * normal.rhs_squared_norm()[0];
    for (const auto& [name, found] : ways) {
      CAPTURE(seed);
      CAPTURE(name);
      CAPTURE(static_cast<int>(what));
      CHECK(found.report.kkt_residual[0] <= 1e-9);
      CHECK(found.weights.minCoeff() >= 0.0);
      CHECK(std::abs(found.report.objective[0] - ways[0].second.report.objective[0]) <= 1e-8 * scale);
      worst_kkt_residual = std::max(worst_kkt_residual, found.report.kkt_residual[0]);
      worst_disagreement = std::max(worst_disagreement,
                                    std::abs(found.report.objective[0] - ways[0].second.report.objective[0]) / scale);
    }
  }
  MESSAGE("worst KKT residual ", worst_kkt_residual, ", worst disagreement ", worst_disagreement);
}

TEST_CASE("a start from columns that depend on each other does not end with those that left barred") {
  using random_problems::kind;
  std::size_t uncertified = 0;
  for (unsigned seed = 0; seed < 6000; ++seed) {
    random_problems::generator random(seed);
    const std::array kinds{kind::rank_deficient, kind::duplicated_columns, kind::wide};
    const auto problem = random.make(kinds[seed % 3], 7);
    const normal_equations normal = problem.normal();
    for (const auto& [name, found] : all_ways(normal)) uncertified += found.report.kkt_residual[0] <= 1e-9 ? 0u : 1u;
  }
  CHECK(uncertified == 0u);
}

TEST_CASE("the optimum is that of trying every support") {
  CHECK(rc::check([] {
    random_problems::generator random(*rc::gen::arbitrary<unsigned>());
    const auto what = static_cast<random_problems::kind>(*rc::gen::inRange(0, random_problems::kinds));
    RC_PRE(what != random_problems::kind::ill_conditioned && what != random_problems::kind::badly_scaled);
    const auto problem = random.make(what, 7);
    const double least = least_objective(problem), scale = 0.5 * problem.right.squaredNorm();
    for (const auto& [name, found] : all_ways(problem.normal()))
      RC_ASSERT(std::abs(found.report.objective[0] - least) <= 1e-10 * scale);
  }));
}

TEST_CASE("the golden instances, a real 99 x 99 Gram matrix of condition 4e7 among them") {
  for (const auto& instance : golden_json("nnls.json")) {
    const auto q = instance["Q"].get<std::vector<std::vector<double>>>();
    const auto c = instance["c"].get<std::vector<double>>(), x = instance["x"].get<std::vector<double>>();
    const Eigen::Index k = std::ssize(c);
    Eigen::MatrixXd gram(k, k);
    for (Eigen::Index row = 0; row < k; ++row) gram.row(row) = Eigen::Map<const Eigen::RowVectorXd>(q[row].data(), k);
    const normal_equations normal(gram, Eigen::Map<const Eigen::VectorXd>(c.data(), k));
    const Eigen::VectorXd expected = Eigen::Map<const Eigen::VectorXd>(x.data(), k);
    const double objective = normal.objective(expected)[0];
    for (const auto& [name, found] : all_ways(normal)) {
      CAPTURE(instance["kind"].get<std::string>());
      CAPTURE(name);
      CHECK(found.report.kkt_residual[0] <= 1e-9);
      CHECK(found.report.objective[0] == doctest::Approx(objective).epsilon(1e-10));
      if (instance["kind"] != "dup")  // the optimum of "dup" is not unique
        CHECK((found.weights.col(0) - expected).cwiseAbs().maxCoeff() <= 1e-6 * (1.0 + expected.maxCoeff()));
    }
  }
}

TEST_CASE(
    "the linear combinations of the small golden instance, with outliers and without, and each of its leave-one-outs") {
  // Eleven materials; the twelfth is measured at every third row. See /shared/reference/python/golden.py.
  const auto golden = golden_json("small_noell.json");
  const auto names = golden_json("small_ridge.json")["materials"].get<std::vector<std::string>>();
  const auto table = golden_csv("small_brdf.csv");
  const auto measured = golden["measured_rows"].get<std::vector<Eigen::Index>>();
  const auto outliers = golden["outlier_positions"].get<std::vector<Eigen::Index>>();
  const auto sources = golden["outlier_source_rows"].get<std::vector<Eigen::Index>>();
  for (std::size_t c = 0; c < 3; ++c) {
    const auto column = [&](std::size_t material) { return table.at(names[material] + "_" + "RGB"[c]); };
    Eigen::MatrixXd all(std::ssize(column(0)), 12);
    for (std::size_t m = 0; m < 12; ++m)
      all.col(m) = Eigen::Map<const Eigen::VectorXd>(column(m).data(), all.rows()).array().log1p();
    const auto expect = [](const gonio::solution& found, const nlohmann::json& expected) {
      const auto alpha = expected.get<std::vector<double>>();
      CHECK(found.report.kkt_residual[0] <= 1e-9);
      for (std::size_t i = 0; i < alpha.size(); ++i)
        CHECK(found.weights(i, 0) == doctest::Approx(alpha[i]).epsilon(1e-6).scale(1e-3));
    };

    const Eigen::MatrixXd known = all.leftCols(11), gram = known.transpose() * known;
    for (Eigen::Index target = 0; target < 11; ++target)
      expect(gonio::nnls().solve(gonio::leave_one_out(gram, target, gonio::all_but(11, target))),
             golden["channels"][c]["loo_alpha"][target]);

    gonio::row_matrix rows(std::ssize(measured), 11);
    Eigen::MatrixXd clean(rows.rows(), 1);
    for (std::size_t i = 0; i < measured.size(); ++i) {
      rows.row(i) = known.row(measured[i]);
      clean(i, 0) = all(measured[i], 11);
    }
    Eigen::MatrixXd disturbed = clean;
    for (std::size_t i = 0; i < outliers.size(); ++i) disturbed(outliers[i], 0) = all(sources[i], 11);
    const auto& channel = golden["channels"][c];
    expect(gonio::nnls().solve(gonio::least_squares_problem(rows, clean)), channel["clean_gamma0"]["alpha"]);
    expect(gonio::nnls().solve(gonio::least_squares_problem(rows, disturbed)), channel["outliers_gamma3"]["alpha"]);
  }
}

TEST_CASE("several right-hand sides are solved one by one") {
  random_problems::generator random(5);
  const auto problem = random.make(random_problems::kind::ordinary);
  const Eigen::MatrixXd right = random.gaussian(problem.matrix.rows(), 3);
  const gonio::row_matrix rows = problem.matrix;
  const auto together = gonio::nnls().solve(gonio::least_squares_problem(rows, right));
  for (Eigen::Index c = 0; c < 3; ++c) {
    const auto alone = gonio::nnls().solve(gonio::least_squares_problem(rows, right.col(c)));
    CHECK(together.weights.col(c) == alone.weights.col(0));
    CHECK(together.report.residual[c] == doctest::Approx((problem.matrix * alone.weights - right.col(c)).norm()));
  }
}

TEST_CASE("the iteration steps by hand, and the objective never rises") {
  random_problems::generator random(11);
  const auto normal = random.make(random_problems::kind::non_negative_data, 40).normal();
  double last = 0.0;
  int steps = 0;
  for (gonio::nnls::iteration run(normal, 0); !run.converged(); run.step(), ++steps) {
    const double objective = normal.objective(run.result())[0];
    CHECK(objective <= last);
    last = objective;
  }
  CHECK(steps > 0);
}

TEST_CASE("a warm start from the optimum has nothing to do") {
  random_problems::generator random(12);
  const auto normal = random.make(random_problems::kind::non_negative_data, 40).normal();
  const auto found = gonio::nnls().solve(normal);
  gonio::nnls::iteration run(normal, 0);
  run.start_from(found.weights.col(0));
  CHECK(run.converged());
  CHECK(run.result().isApprox(found.weights.col(0), 1e-12));
}

TEST_CASE("block pivoting steps by hand to the weights of the active set, where nothing is free too") {
  random_problems::generator random(13);
  const auto problem = random.make(random_problems::kind::non_negative_data, 40);
  const auto normal = problem.normal();
  const normal_equations against(normal.gram(), -normal.gram().rowwise().sum());
  for (const auto& [equations, expected] : {std::pair{normal, gonio::nnls().solve(normal).weights},
                                            {against, Eigen::MatrixXd::Zero(normal.unknowns(), 1).eval()}}) {
    gonio::nnls_block_pivoting::iteration run(equations, 0);
    gonio::run_to_convergence(run, gonio::step_limit(equations.unknowns()), "block principal pivoting");
    CHECK(run.result().isApprox(expected.col(0), 1e-10));
  }
}

TEST_CASE("an iteration that does not end is an error") {
  struct endless {
    Eigen::VectorXd x;
    void step() {}
    bool converged() const { return false; }
    const Eigen::VectorXd& result() const { return x; }
  };
  endless run;
  CHECK_THROWS_WITH_AS(gonio::run_to_convergence(run, 50, "this method"),
                       doctest::Contains("this method has not converged after 50 steps"), gonio::error);
}

TEST_CASE("numbers that overflow end in an error or in weights that are certified, and do end") {
  Eigen::MatrixXd huge = Eigen::MatrixXd::Constant(3, 3, 1e308);
  huge.diagonal().array() *= 1.5;
  const normal_equations normal(huge, Eigen::Vector3d(1e308, -1e308, 1e-308));
  try {
    const auto found = gonio::nnls().solve(normal);
    CHECK_FALSE(found.weights.hasNaN());
    CHECK(found.report.kkt_residual[0] <= 1e-9);
  } catch (const gonio::error& refused) {
    CHECK(std::string(refused.what()).find("NNLS") != std::string::npos);
  }
}

TEST_CASE("an indefinite matrix is no Gram matrix: an answer is certified or there is none") {
  Eigen::MatrixXd indefinite(2, 2);
  indefinite << 1, -2, -2, 1;
  try {
    const auto found = gonio::nnls().solve(normal_equations(indefinite, Eigen::Vector2d(1, 1)));
    CHECK(found.report.kkt_residual[0] <= 1e-9);
  } catch (const gonio::error& refused) {
    CHECK(std::string(refused.what()).find("NNLS") != std::string::npos);
  }
}
