#include "../golden.hpp"
#include "../json.hpp"
#include "random_problems.hpp"
#include <gonio/solve/tikhonov.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <random>

using gonio::least_squares_problem;
using gonio::row_matrix;
using gonio::tikhonov;

TEST_CASE("the primal and the dual form agree, tall and wide, weighted and not, and are certified") {
  CHECK(rc::check([] {
    const auto n = *rc::gen::inRange<Eigen::Index>(1, 40), k = *rc::gen::inRange<Eigen::Index>(1, 40);
    const auto seed = *rc::gen::arbitrary<unsigned>();
    const double eta = std::pow(10.0, *rc::gen::inRange(-30, 40) * 0.1);
    const Eigen::VectorXd weights = random_matrix(n, 1, seed + 2).cwiseAbs();
    const least_squares_problem problem(random_matrix(n, k, seed), random_matrix(n, 3, seed + 1), weights);
    const auto primal = tikhonov(eta, tikhonov::form::primal).solve(problem);
    const auto dual = tikhonov(eta, tikhonov::form::dual).solve(problem);
    const double scale = 1.0 + primal.weights.cwiseAbs().maxCoeff();
    RC_ASSERT((primal.weights - dual.weights).cwiseAbs().maxCoeff() < 1e-10 * scale);
    RC_ASSERT(primal.report.kkt_residual.maxCoeff() < 1e-9);
    RC_ASSERT(dual.report.kkt_residual.maxCoeff() < 1e-9);
  }));
}

TEST_CASE("a closed form: one equation, one unknown") {
  const auto found =
      tikhonov(3.0).solve(least_squares_problem{row_matrix::Constant(1, 1, 2.0), Eigen::MatrixXd::Constant(1, 1, 7.0)});
  CHECK(found.weights(0, 0) == doctest::Approx(2.0 * 7.0 / (2.0 * 2.0 + 3.0)));
  CHECK(found.report.residual[0] == doctest::Approx(7.0 - 2.0 * 2.0));
}

TEST_CASE("a sample of weight zero does not count, one of weight two counts twice") {
  const row_matrix rows = random_matrix(4, 6, 1);
  const Eigen::MatrixXd right = random_matrix(4, 1, 2);
  row_matrix repeated(4, 6);
  repeated << rows.topRows(3), rows.row(2);
  Eigen::MatrixXd repeated_right(4, 1);
  repeated_right << right.topRows(3), right.row(2);
  const auto weighted = tikhonov(0.5).solve(least_squares_problem{rows, right, Eigen::Vector4d(1, 1, 2, 0)});
  const auto twice = tikhonov(0.5).solve(least_squares_problem{repeated, repeated_right});
  CHECK(weighted.weights.isApprox(twice.weights, 1e-12));
}

TEST_CASE("the ridge reconstruction of the small golden instance") {
  // The 11 materials x RGB on which the reference trains, mapped by the log-relative metric of their median;
  // "yellow-paint" is the test. /shared/reference/python/golden.py made the file.
  const auto golden = golden_json("small_ridge.json");
  const auto table = golden_csv("small_brdf.csv");
  const auto names = golden["materials"].get<std::vector<std::string>>();
  const auto& cosine = table.at("cosweight");
  const Eigen::Index cells = std::ssize(cosine);
  const auto column = [&](std::size_t material, int channel) -> const std::vector<double>& {
    return table.at(names[material] + "_" + "RGB"[channel]);
  };
  std::vector<double> median(cosine.size());
  for (Eigen::Index cell = 0; cell < std::ssize(median); ++cell) {
    std::vector<double> row;
    for (std::size_t m = 0; m < 11; ++m)
      for (int c = 0; c < 3; ++c) row.push_back(column(m, c)[cell]);
    std::ranges::nth_element(row, row.begin() + 16);
    median[cell] = row[16];
  }
  const auto map = [&](double rho, Eigen::Index cell) {
    const std::size_t i = cell;
    return std::log((rho * cosine[i] + 1e-3) / (median[i] * cosine[i] + 1e-3));
  };
  row_matrix mapped(cells, 33);
  for (Eigen::Index cell = 0; cell < cells; ++cell)
    for (Eigen::Index j = 0; j < 33; ++j) mapped(cell, j) = map(column(j / 3, static_cast<int>(j % 3))[cell], cell);
  const Eigen::VectorXd mean = mapped.rowwise().mean();
  mapped.colwise() -= mean;
  CHECK(mean[3] == doctest::Approx(golden["mu_first20"][3].get<double>()).epsilon(1e-12));

  for (const double eta : {40.0, 1.0}) {
    const auto& expected = golden[eta == 40.0 ? "eta_40" : "eta_1"];
    // With all components kept, the scaled components are a rotation of the observations, so the reference's dual
    // weights are the weights of this problem.
    const auto samples = golden["rows_of_small_brdf"].get<std::vector<Eigen::Index>>();
    row_matrix rows(5, 33);
    Eigen::MatrixXd right(5, 3);
    for (Eigen::Index i = 0; i < 5; ++i) {
      const Eigen::Index cell = samples[i];
      rows.row(i) = mapped.row(cell);
      for (int c = 0; c < 3; ++c) right(i, c) = map(column(11, c)[cell], cell) - mean[cell];
    }
    const auto found = tikhonov(eta).solve(least_squares_problem{rows, right});
    for (Eigen::Index j = 0; j < 33; ++j)
      for (Eigen::Index c = 0; c < 3; ++c)
        CHECK(found.weights(j, c) ==
              doctest::Approx(expected["dual_weights"][j][c].get<double>()).epsilon(1e-9).scale(0.01));
    for (int c = 0; c < 3; ++c) {
      const Eigen::VectorXd estimate = mapped * found.weights.col(c) + mean;
      double sum = 0;
      for (Eigen::Index cell = 0; cell < cells; ++cell)
        sum += std::pow(estimate[cell] - map(column(11, c)[cell], cell), 2);
      CHECK(std::sqrt(sum / static_cast<double>(cells)) ==
            doctest::Approx(expected["rms_mapped"][c].get<double>()).epsilon(1e-9));
    }
  }
}

TEST_CASE("without a row of positive weight the penalty alone decides, in both forms") {
  const least_squares_problem ignored(row_matrix::Ones(2, 3), Eigen::MatrixXd::Ones(2, 1), Eigen::Vector2d::Zero());
  for (const auto form : {tikhonov::form::primal, tikhonov::form::dual}) {
    const auto found = tikhonov(1.0, form).solve(ignored);
    CHECK(found.weights.isZero(0.0));
    CHECK(found.report.kkt_residual[0] == 0.0);
    CHECK(found.report.residual[0] == 0.0);
  }
}

TEST_CASE("a row that turns out not to be finite where it is read is refused by name, in both forms") {
  row_matrix rows = row_matrix::Ones(2, 3);
  rows(1, 2) = std::nan("");
  const least_squares_problem broken(gonio::rows_of(rows), Eigen::MatrixXd::Ones(2, 1));
  for (const auto form : {tikhonov::form::automatic, tikhonov::form::primal, tikhonov::form::dual})
    CHECK_THROWS_WITH_AS(tikhonov(1.0, form).solve(broken),
                         "row 1 of a least-squares problem is not finite in column 2", gonio::error);
}

TEST_CASE("a penalty whose inverse overflows gives no weights that are not numbers") {
  const least_squares_problem problem(row_matrix::Ones(1, 1), Eigen::MatrixXd::Constant(1, 1, 3.0));
  CHECK(tikhonov(1e-310, tikhonov::form::primal).solve(problem).weights(0, 0) == doctest::Approx(3.0));
  CHECK_THROWS_WITH_AS(tikhonov(1e-310, tikhonov::form::dual).solve(problem), doctest::Contains("found no optimum"),
                       gonio::error);
}

TEST_CASE("a penalty that is not positive and finite is refused") {
  CHECK_THROWS_AS(tikhonov(0.0), gonio::error);
  CHECK_THROWS_AS(tikhonov(-1.0), gonio::error);
  CHECK_THROWS_AS(tikhonov(std::nan("")), gonio::error);
}
