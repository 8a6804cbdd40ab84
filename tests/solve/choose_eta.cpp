#include "../dense_reference.hpp"
#include "random_problems.hpp"
#include <gonio/solve/choose_eta.hpp>

#include <Eigen/Eigenvalues>
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

using gonio::automatic_tikhonov;
using gonio::choose_eta;
using gonio::cross_validate;
using gonio::eta_criterion;
using gonio::least_squares_problem;
using gonio::tikhonov;

namespace {

constexpr eta_criterion criteria[] = {eta_criterion::generalised_cross_validation, eta_criterion::leave_one_out};

/// Rows of columns with falling lengths, noisy right-hand sides, and weights, some of them zero.
least_squares_problem noisy_problem(Eigen::Index n, Eigen::Index k, double noise, unsigned seed) {
  Eigen::MatrixXd rows = random_matrix(n, k, seed);
  for (Eigen::Index column = 0; column < k; ++column) rows.col(column) *= std::pow(0.8, static_cast<double>(column));
  const Eigen::MatrixXd right = rows * random_matrix(k, 2, seed + 1) + noise * random_matrix(n, 2, seed + 2);
  Eigen::VectorXd weights =
      random_matrix(n, 1, seed + 3).unaryExpr([](double value) { return value < -0.8 ? 0.0 : std::abs(value) + 0.1; });
  weights.head(2).setOnes();
  return {rows, right, weights};
}

/// Returns the squared error of predicting each row from a fit without it.
double by_refitting(const least_squares_problem& problem, double eta) {
  double sum = 0.0;
  for (Eigen::Index left_out = 0; left_out < problem.equations(); ++left_out) {
    Eigen::VectorXd weights = problem.weights();
    const double weight = weights[left_out];
    if (weight == 0.0) continue;
    weights[left_out] = 0.0;
    const Eigen::MatrixXd x =
        tikhonov(eta).solve(least_squares_problem{problem.rows(), problem.right_hand_side(), weights}).weights;
    weights.setZero();
    weights[left_out] = weight;
    sum += least_squares_problem(problem.rows(), problem.right_hand_side(), weights).residual(x).squaredNorm();
  }
  return sum;
}

/// The definition, with the hat matrix W^(1/2) A (A'WA + eta I)^-1 A'W^(1/2), for rows of positive weight.
double by_hat_matrix(const least_squares_problem& problem, double eta) {
  const Eigen::Index n = problem.equations();
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(n, n);
  root.diagonal() = problem.weights().cwiseSqrt();
  const Eigen::MatrixXd all = problem.rows(), rows = root * all, columns = rows.transpose();
  const Eigen::MatrixXd right = root * problem.right_hand_side();
  const Eigen::MatrixXd solved =
      tikhonov(eta).solve(least_squares_problem{rows, Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n))}).weights;
  const Eigen::MatrixXd hat = rows * solved;
  const auto count = static_cast<double>((problem.weights().array() > 0.0).count());
  const Eigen::MatrixXd residual = right - hat * right;
  return count * residual.squaredNorm() / std::pow(count - hat.trace(), 2);
}

double score(const least_squares_problem& problem, eta_criterion criterion, double eta) {
  return cross_validate(problem, criterion, Eigen::VectorXd::Constant(1, eta))[0];
}

}  // namespace

TEST_CASE("leave-one-out is refitting without each row, generalised cross-validation is its definition") {
  CHECK(rc::check([] {
    const auto n = *rc::gen::inRange<Eigen::Index>(2, 20), k = *rc::gen::inRange<Eigen::Index>(1, 20);
    const auto problem = noisy_problem(n, k, 0.3, *rc::gen::arbitrary<unsigned>());
    Eigen::VectorXd etas(3);
    for (double& eta : etas) eta = std::pow(10.0, *rc::gen::inRange(-30, 30) * 0.1);
    const auto refitted = cross_validate(problem, eta_criterion::leave_one_out, etas);
    const auto generalised = cross_validate(problem, eta_criterion::generalised_cross_validation, etas);
    for (Eigen::Index e = 0; e < 3; ++e) {
      const double press = by_refitting(problem, etas[e]), defined = by_hat_matrix(problem, etas[e]);
      RC_ASSERT(std::abs(refitted[e] - press) < 1e-8 * press);
      RC_ASSERT(std::abs(generalised[e] - defined) < 1e-8 * defined);
    }
  }));
}

TEST_CASE("several problems with one eta: their criteria add up, and those with too few observations say nothing") {
  for (const eta_criterion criterion : criteria)
    for (unsigned seed = 0; seed < 5; ++seed) {
      const auto both = noisy_problem(12, 20, 0.3, seed);
      const auto column = [&](Eigen::Index c) {
        return least_squares_problem(both.rows(), Eigen::MatrixXd(both.right_hand_side().col(c)), both.weights());
      };
      const std::vector<least_squares_problem> apart{column(0), column(1)};
      const double eta = choose_eta(both, criterion);
      CHECK(choose_eta(apart, criterion) == doctest::Approx(eta).epsilon(1e-9));
      Eigen::VectorXd nothing = Eigen::VectorXd::Zero(12);
      nothing[3] = 1.0;
      const std::vector<least_squares_problem> with_one{
          column(0), {both.rows(), Eigen::MatrixXd(both.right_hand_side().col(1)), nothing}};
      CHECK(choose_eta(with_one, criterion) == choose_eta(column(0), criterion));
    }
  CHECK_THROWS_AS(choose_eta(std::vector<least_squares_problem>{}, criteria[0]), gonio::error);
}

TEST_CASE("more rows than a block holds") {
  const auto problem = noisy_problem(2500, 4, 0.3, 5);
  const double eta = 7.0;
  const Eigen::MatrixXd x = tikhonov(eta).solve(problem).weights;
  const Eigen::MatrixXd inverse =
      tikhonov(eta)
          .solve(least_squares_problem{problem.rows(), Eigen::MatrixXd(problem.rows()), problem.weights()})
          .weights;
  // (Q + eta I)^-1 Q = I - eta (Q + eta I)^-1.
  const Eigen::MatrixXd penalised = (Eigen::MatrixXd::Identity(4, 4) - inverse) / eta, rows = problem.rows();
  double press = 0.0, squares = 0.0, trace = 0.0, count = 0.0;
  for (Eigen::Index row = 0; row < 2500; ++row) {
    const double weight = problem.weights()[row];
    if (weight == 0.0) continue;
    const Eigen::VectorXd a = rows.row(row), solved = penalised * a;
    const double leverage = weight * a.dot(solved);
    for (Eigen::Index column = 0; column < 2; ++column) {
      const double misfit = a.dot(x.col(column)) - problem.right_hand_side()(row, column);
      press += weight * std::pow(misfit / (1.0 - leverage), 2);
      squares += weight * misfit * misfit;
    }
    trace += leverage;
    count += 1.0;
  }
  CHECK(score(problem, eta_criterion::leave_one_out, eta) == doctest::Approx(press).epsilon(1e-11));
  CHECK(score(problem, eta_criterion::generalised_cross_validation, eta) ==
        doctest::Approx(count * squares / std::pow(count - trace, 2)).epsilon(1e-11));
}

TEST_CASE("the score of the chosen eta is within 1 % of the least on a dense scan") {
  unsigned seed = 0;
  for (const auto& [n, k] : {std::pair{5, 40}, {12, 12}, {13, 12}, {40, 12}, {300, 20}})
    for (const double noise : {0.0, 0.01, 0.3, 3.0, 100.0})
      for (const eta_criterion criterion : criteria) {
        const auto problem = noisy_problem(n, k, noise, ++seed);
        CAPTURE(n);
        CAPTURE(noise);
        const double eta = choose_eta(problem, criterion);
        const double largest = dense_reference::symmetric_eigen(problem.normal().gram()).values.maxCoeff();
        const Eigen::VectorXd scan = gonio::geometric_sequence(1e-10 * largest, 1e2 * largest, 2001);
        CHECK(score(problem, criterion, eta) <= 1.01 * cross_validate(problem, criterion, scan).minCoeff() + 1e-20);
      }
}

TEST_CASE("equations that the unknowns explain need no penalty; noise that they do not gets the largest") {
  const Eigen::MatrixXd rows = random_matrix(200, 6, 1);
  const Eigen::MatrixXd right = rows * random_matrix(6, 1, 2);
  for (const eta_criterion criterion : criteria) {
    const double largest =
        dense_reference::symmetric_eigen(least_squares_problem(rows, right).normal().gram()).values.maxCoeff();
    CHECK(choose_eta({rows, right}, criterion) < 0.1 * largest);
    CHECK(automatic_tikhonov(criterion).solve({rows, right}).report.residual[0] < 0.02 * right.norm());
    // If signs alternate, the mean of the others predicts worse than zero does.
    Eigen::MatrixXd alternating = Eigen::MatrixXd::Ones(10, 1);
    for (Eigen::Index row = 0; row < 10; row += 2) alternating(row, 0) = -1.0;
    CHECK(choose_eta({Eigen::MatrixXd::Ones(10, 1), alternating}, criterion) == doctest::Approx(1000.0));
  }
}

TEST_CASE("where no eta is better than another the largest is chosen") {
  for (const eta_criterion criterion : criteria) {
    // b = 0; then orthogonal rows, which do not predict each other.
    CHECK(choose_eta({Eigen::MatrixXd::Identity(3, 3), Eigen::MatrixXd::Zero(3, 1)}, criterion) ==
          doctest::Approx(100.0));
    CHECK(choose_eta({Eigen::MatrixXd::Identity(3, 5), Eigen::MatrixXd::Ones(3, 1)}, criterion) ==
          doctest::Approx(100.0));
  }
}

TEST_CASE("dependent columns and rows, tall and wide") {
  for (const auto& [n, k] : {std::pair{30, 8}, {8, 30}}) {
    const Eigen::MatrixXd rows = random_matrix(n, 3, 1) * random_matrix(3, k, 2);
    const Eigen::MatrixXd right = rows * random_matrix(k, 1, 3) + 0.1 * random_matrix(n, 1, 4);
    for (const eta_criterion criterion : criteria) {
      const least_squares_problem problem(rows, right);
      const double eta = choose_eta(problem, criterion);
      CHECK(score(problem, criterion, eta) < 1.3 * 0.01 * n);
      CHECK(automatic_tikhonov(criterion).solve(problem).report.kkt_residual[0] < 1e-9);
    }
  }
}

TEST_CASE("the solver is Tikhonov's with the chosen eta, and rows without weight do not matter") {
  for (const eta_criterion criterion : criteria)
    for (const auto& [n, k] : {std::pair{30, 8}, {8, 30}}) {
      const auto problem = noisy_problem(n, k, 0.3, 11);
      const double eta = choose_eta(problem, criterion);
      const auto found = automatic_tikhonov(criterion).solve(problem);
      CHECK(found.weights == tikhonov(eta).solve(problem).weights);
      CHECK(found.report.kkt_residual.maxCoeff() < 1e-9);

      Eigen::MatrixXd rows(n + 40, k), right(n + 40, 2);
      rows << problem.rows(), random_matrix(40, k, 1);
      right << problem.right_hand_side(), random_matrix(40, 2, 2);
      Eigen::VectorXd weights = Eigen::VectorXd::Zero(n + 40);
      weights.head(n) = problem.weights();
      CHECK(choose_eta({rows, right, weights}, criterion) == doctest::Approx(eta).epsilon(1e-6));
    }
}

TEST_CASE("a choice among plausible etas is the best of these") {
  for (const eta_criterion criterion : criteria)
    for (const auto& [n, k] : {std::pair{30, 8}, {8, 30}}) {
      const auto problem = noisy_problem(n, k, 0.3, 21);
      const double free = choose_eta(problem, criterion);
      CHECK(choose_eta(problem, criterion, {2.0 * free, 50.0 * free}) >= 2.0 * free);
      CHECK(choose_eta(problem, criterion, {0.0, 0.5 * free}) <= 0.5 * free);
      CHECK(choose_eta(problem, criterion, {0.1 * free, 10.0 * free}) == doctest::Approx(free).epsilon(0.02));
      CHECK(choose_eta(problem, criterion, {3.0, 3.0}) == 3.0);
      const gonio::eta_range range{0.03 * free, 0.3 * free};
      const double eta = choose_eta(problem, criterion, range);
      const Eigen::VectorXd scan = gonio::geometric_sequence(range.lowest, range.highest, 501);
      CHECK(score(problem, criterion, eta) <= 1.001 * cross_validate(problem, criterion, scan).minCoeff());
      CHECK(automatic_tikhonov(criterion, range).solve(problem).weights == tikhonov(eta).solve(problem).weights);
    }
  // Nothing favours a smaller eta.
  const least_squares_problem single(random_matrix(1, 2, 1), random_matrix(1, 1, 2));
  CHECK(choose_eta(single, eta_criterion::leave_one_out, {1.0, 7.0}) == 7.0);
  for (const gonio::eta_range& impossible :
       {gonio::eta_range{-1.0, 1.0}, {2.0, 1.0}, {0.0, 0.0}, {std::nan(""), 1.0}, {0.0, std::nan("")}})
    CHECK_THROWS_AS(automatic_tikhonov(eta_criterion::leave_one_out, impossible), gonio::error);
}

TEST_CASE("too few observations and bad input are refused") {
  const Eigen::MatrixXd rows = random_matrix(3, 2, 1), right = random_matrix(3, 1, 2);
  for (const eta_criterion criterion : criteria) {
    CHECK_THROWS_AS(choose_eta({rows.topRows(1), right.topRows(1)}, criterion), gonio::error);
    CHECK_THROWS_WITH_AS(choose_eta({rows, right, Eigen::Vector3d(0, 1, 0)}, criterion),
                         "choosing eta by cross-validation needs at least 2 rows of positive weight, not 1",
                         gonio::error);
    CHECK(choose_eta({rows.topRows(2), right.topRows(2)}, criterion) > 0.0);
    CHECK_THROWS_AS(choose_eta({Eigen::MatrixXd::Zero(3, 2), right}, criterion), gonio::error);
    CHECK_THROWS_AS(score({rows, right}, criterion, 0.0), gonio::error);
    CHECK_THROWS_AS(score({rows, right}, criterion, std::nan("")), gonio::error);
    CHECK_THROWS_AS(cross_validate({rows, right}, criterion, Eigen::VectorXd()), gonio::error);
    for (const Eigen::Index n : {2, 5}) {
      const gonio::row_source broken{n, 3, [](gonio::block, gonio::row_block out) {
                                       out.setOnes();
                                       out(1, 2) = std::numeric_limits<double>::quiet_NaN();
                                     }};
      CHECK_THROWS_AS(choose_eta(least_squares_problem(broken, Eigen::MatrixXd::Ones(n, 1)), criterion), gonio::error);
    }
  }
}
