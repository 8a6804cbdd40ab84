#include "random_problems.hpp"
#include <gonio/solve/lasso.hpp>
#include <gonio/solve/nnls.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::lasso;
using gonio::non_negative_lasso;
using gonio::normal_equations;
using gonio::sign_rule;

TEST_CASE("the optimality conditions hold on random problems of all kinds, with both signs and with one") {
  double worst = 0.0;
  for (unsigned seed = 0; seed < 1100; ++seed) {
    random_problems::generator random(seed);
    const auto normal = random.make(static_cast<random_problems::kind>(seed % random_problems::kinds)).normal();
    const double share = std::pow(10.0, random.uniform(-6.0, 0.1));
    CAPTURE(seed);
    const auto both = lasso(share * gonio::largest_lambda(normal, sign_rule::any)).solve(normal);
    const auto one = non_negative_lasso(share * gonio::largest_lambda(normal, sign_rule::non_negative)).solve(normal);
    CHECK(both.report.kkt_residual[0] <= 1e-9);
    CHECK(one.report.kkt_residual[0] <= 1e-9);
    CHECK(one.weights.minCoeff() >= 0.0);
    if (share >= 1.0) CHECK(both.weights.isZero(0.0));
    worst = std::max({worst, both.report.kkt_residual[0], one.report.kkt_residual[0]});
  }
  MESSAGE("worst KKT residual ", worst);
}

TEST_CASE("with orthogonal columns the solution is the soft threshold of least squares") {
  CHECK(rc::check([] {
    random_problems::generator random(*rc::gen::arbitrary<unsigned>());
    const auto k = *rc::gen::inRange<Eigen::Index>(1, 30);
    Eigen::VectorXd squares(k);
    for (double& square : squares) square = random.uniform(0.1, 10.0);
    const Eigen::VectorXd rhs = random.gaussian(k, 1);
    const double lambda = random.uniform(0.0, 2.0);
    const normal_equations normal(squares.asDiagonal(), rhs);
    const auto both = lasso(lambda).solve(normal), one = non_negative_lasso(lambda).solve(normal);
    for (Eigen::Index j = 0; j < k; ++j) {
      const double shrunk = std::max(std::abs(rhs[j]) - lambda, 0.0) / squares[j];
      RC_ASSERT(std::abs(both.weights(j, 0) - std::copysign(shrunk, rhs[j])) <= 1e-14 * (1.0 + shrunk));
      RC_ASSERT(std::abs(one.weights(j, 0) - (rhs[j] > 0.0 ? shrunk : 0.0)) <= 1e-14 * (1.0 + shrunk));
    }
  }));
}

TEST_CASE("at the largest penalty all weights of all right-hand sides are zero, and not below it") {
  const Eigen::MatrixXd rhs{{1.0, -7.0}, {3.0, 2.0}};
  const normal_equations normal(Eigen::MatrixXd::Identity(2, 2), rhs);
  CHECK(gonio::largest_lambda(normal, sign_rule::any) == 7.0);
  CHECK(gonio::largest_lambda(normal, sign_rule::non_negative) == 3.0);
  CHECK(lasso(7.0).solve(normal).weights.isZero(0.0));
  CHECK_FALSE(lasso(6.9).solve(normal).weights.isZero(0.0));
  CHECK(non_negative_lasso(3.0).solve(normal).weights.isZero(0.0));
  CHECK_FALSE(non_negative_lasso(2.9).solve(normal).weights.isZero(0.0));
}

TEST_CASE("the objective counts the penalty") {
  const normal_equations normal(Eigen::MatrixXd::Constant(1, 1, 2.0), Eigen::MatrixXd::Constant(1, 1, 5.0),
                                Eigen::VectorXd::Constant(1, 25.0));
  const auto found = lasso(1.0).solve(normal);
  CHECK(found.weights(0, 0) == doctest::Approx(2.0));
  CHECK(found.report.objective[0] == doctest::Approx(0.5 * 2.0 * 4.0 - 5.0 * 2.0 + 2.0));
}

TEST_CASE("of two equal columns the penalty needs only one, and of two opposite ones too") {
  Eigen::MatrixXd a(3, 3);
  a << 1, 1, -1, 0, 0, 0, 2, 2, -2;
  const Eigen::Vector3d b(1, 5, 2);
  const auto found = lasso(0.5).solve(normal_equations(a.transpose() * a, a.transpose() * b));
  CHECK((found.weights.array() != 0.0).count() == 1);
  CHECK(found.weights.cwiseAbs().sum() == doctest::Approx((5.0 - 0.5) / 5.0));
}

TEST_CASE("a column that is the sum of two others replaces them if this shortens the weights") {
  // Column 2 is the sum of columns 0 and 1. Reaching b = a0 + a1 by column 2 has half the penalty.
  Eigen::MatrixXd a(2, 3);
  a << 1, 0, 1, 0, 1, 1;
  const normal_equations normal(a.transpose() * a, a.transpose() * Eigen::Vector2d(1, 1));
  gonio::lasso::iteration cold(normal, 0, 0.01);
  gonio::active_set<sign_rule::any> warm(normal, 0, 0.01);
  warm.start_from(Eigen::Vector3d(0.9, 0.9, 0.0));
  CHECK_FALSE(warm.converged());
  gonio::run_to_convergence(cold, 100, "cold");
  gonio::run_to_convergence(warm, 100, "warm");
  CHECK(warm.result().isApprox(cold.result(), 1e-12));
  CHECK(warm.result()[0] == 0.0);
  CHECK(warm.result()[2] == doctest::Approx((2.0 - 0.01) / 2.0));
}

TEST_CASE("invalid penalties are refused") {
  CHECK_THROWS_AS(lasso(-1.0), gonio::error);
  CHECK_THROWS_AS(lasso(std::nan("")), gonio::error);
}
