#include "../dense_reference.hpp"
#include "random_problems.hpp"
#include <gonio/solve/truncated_svd.hpp>

#include <Eigen/SVD>
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <random>

using gonio::least_squares_problem;
using gonio::row_matrix;
using gonio::truncated_svd;

namespace {

/// Columns whose lengths fall by `factor` each, times a random matrix. About every fifth weight is zero.
least_squares_problem fading_problem(Eigen::Index n, Eigen::Index k, double factor, unsigned seed) {
  Eigen::MatrixXd rows = random_matrix(n, k, seed);
  for (Eigen::Index column = 0; column < k; ++column) rows.col(column) *= std::pow(factor, static_cast<double>(column));
  const Eigen::MatrixXd mixed = rows * random_matrix(k, k, seed + 1);
  const Eigen::VectorXd weights =
      random_matrix(n, 1, seed + 2).unaryExpr([](double value) { return value < -0.8 ? 0.0 : std::abs(value) + 0.1; });
  return {mixed, random_matrix(n, 2, seed + 3), weights};
}

struct truncated_reference {
  Eigen::MatrixXd x;
  Eigen::Index kept;
  double margin;     // distance of the sums of squares from the threshold; if it is too small, rounding decides
  double condition;  // of the kept part
};

truncated_reference by_truncated_svd(const least_squares_problem& problem, double share) {
  const Eigen::VectorXd root = problem.weights().cwiseSqrt();
  const Eigen::MatrixXd rows = root.asDiagonal() * problem.rows();
  const Eigen::MatrixXd right = root.asDiagonal() * problem.right_hand_side();
  const auto svd = dense_reference::svd(rows);
  const Eigen::VectorXd& singular = svd.values;
  const double total = singular.squaredNorm();
  truncated_reference found{Eigen::MatrixXd::Zero(rows.cols(), right.cols()), 0, 1.0, 1.0};
  double sum = 0.0;
  while (found.kept < singular.size() && sum < share * total) {
    const Eigen::Index i = found.kept++;
    sum += singular[i] * singular[i];
    found.margin = std::min(found.margin, std::abs(sum / total - share));
    found.condition = singular[0] / singular[i];
    for (Eigen::Index column = 0; column < right.cols(); ++column)
      found.x.col(column) += svd.v.col(i) * (svd.u.col(i).dot(right.col(column)) / singular[i]);
  }
  return found;
}

}  // namespace

TEST_CASE("tall and wide problems agree with the truncated singular value decomposition") {
  CHECK(rc::check([] {
    const auto n = *rc::gen::inRange<Eigen::Index>(1, 20), k = *rc::gen::inRange<Eigen::Index>(1, 20);
    const double share = *rc::gen::inRange(1, 999) * 0.001, factor = *rc::gen::inRange(5, 10) * 0.1;
    const auto problem = fading_problem(n, k, factor, *rc::gen::arbitrary<unsigned>());
    const auto expected = by_truncated_svd(problem, share);
    RC_PRE(expected.margin > 1e-9 && expected.condition < 1e3);
    const auto found = truncated_svd(share).solve(problem);
    RC_ASSERT(truncated_svd(share).kept(problem) == expected.kept);
    RC_ASSERT(relative_distance(found.weights, expected.x) < 1e-8);
    RC_ASSERT(relative_distance(found.report.residual, problem.residual(expected.x)) < 1e-9);
    RC_ASSERT(relative_distance(found.report.objective, problem.normal().objective(expected.x)) < 1e-9);
    RC_ASSERT(found.report.kkt_residual.maxCoeff() < 1e-12);
    // Without rows, it always uses the k x k normal equations.
    const auto primal = truncated_svd(share).solve(problem.normal());
    RC_ASSERT(truncated_svd(share).kept(problem.normal()) == expected.kept);
    RC_ASSERT(relative_distance(primal.weights, expected.x) < 1e-8);
    RC_ASSERT(primal.report.kkt_residual.maxCoeff() < 1e-12);
  }));
}

TEST_CASE("KKT residuals hold for any share, also where singular values fall to rounding") {
  CHECK(rc::check([] {
    const auto n = *rc::gen::inRange<Eigen::Index>(1, 30), k = *rc::gen::inRange<Eigen::Index>(1, 30);
    const double share = 1.0 - std::pow(10.0, -*rc::gen::inRange(0, 160) * 0.1) * 0.999;
    const auto problem = fading_problem(n, k, 0.1, *rc::gen::arbitrary<unsigned>());
    RC_ASSERT(truncated_svd(share).solve(problem).report.kkt_residual.maxCoeff() < 1e-9);
    RC_ASSERT(truncated_svd(1.0).solve(problem).report.kkt_residual.maxCoeff() < 1e-9);
    RC_ASSERT(truncated_svd(1.0).solve(problem.normal()).report.kkt_residual.maxCoeff() < 1e-9);
  }));
}

TEST_CASE("a closed form: on a diagonal matrix unknowns are solved for or left at zero") {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(4, 3);
  rows.diagonal() << 1, 3, 2;  // squares 9, 4 and 1, of a total of 14
  const least_squares_problem problem(rows, Eigen::Vector4d(5, 6, 8, 1));
  CHECK(relative_distance(truncated_svd(9.0 / 14 - 1e-9).solve(problem).weights, Eigen::Vector3d(0, 2, 0)) < 1e-14);
  CHECK(relative_distance(truncated_svd(9.0 / 14 + 1e-9).solve(problem).weights, Eigen::Vector3d(0, 2, 4)) < 1e-14);
  CHECK(relative_distance(truncated_svd(13.0 / 14 + 1e-9).solve(problem).weights, Eigen::Vector3d(5, 2, 4)) < 1e-14);
  CHECK(truncated_svd(1e-300).kept(problem) == 1);
  const auto found = truncated_svd(0.7).solve(problem);
  CHECK(found.report.residual[0] == doctest::Approx(std::sqrt(26.0)));
  CHECK(found.report.objective[0] == doctest::Approx(0.5 * (26.0 - 126.0)));
}

TEST_CASE("a share of 1 is the minimum-norm solution: copied columns share the weight, rounding is not kept") {
  for (const Eigen::Index n : {5, 40}) {
    CAPTURE(n);
    const Eigen::MatrixXd half = random_matrix(n, 8, 3);
    Eigen::MatrixXd rows(n, 16);
    rows << half, half;
    const least_squares_problem problem(rows, random_matrix(n, 1, 4));
    CHECK(truncated_svd(1.0).kept(problem) == std::min<Eigen::Index>(n, 8));
    const auto found = truncated_svd(1.0).solve(problem);
    CHECK(relative_distance(found.weights.topRows(8), found.weights.bottomRows(8)) < 1e-12);
    const auto once = truncated_svd(1.0).solve(least_squares_problem{half, problem.right_hand_side()});
    CHECK(relative_distance(2.0 * found.weights.topRows(8), once.weights) < 1e-10);
    CHECK(found.report.residual[0] == doctest::Approx(once.report.residual[0]).scale(1.0));
  }
}

TEST_CASE("nothing to keep") {
  for (const Eigen::Index n : {2, 5}) {
    const auto zero = truncated_svd().solve(least_squares_problem{row_matrix::Zero(n, 3), Eigen::MatrixXd::Ones(n, 2)});
    CHECK(zero.weights.isZero(0.0));
    CHECK(zero.report.kkt_residual.isZero(0.0));
    const auto ignored = truncated_svd().solve(
        least_squares_problem{random_matrix(n, 3, 1), Eigen::MatrixXd::Ones(n, 1), Eigen::VectorXd::Zero(n)});
    CHECK(ignored.weights.isZero(0.0));
  }
}

TEST_CASE("weights that overflow are refused") {
  const auto one_unknown = [](double gram, double rhs) {
    return gonio::normal_equations(Eigen::MatrixXd::Constant(1, 1, gram), Eigen::MatrixXd::Constant(1, 1, rhs));
  };
  CHECK_THROWS_WITH_AS(truncated_svd(1.0).solve(one_unknown(1e-310, 1.0)), doctest::Contains("found no optimum"),
                       gonio::error);
  CHECK(truncated_svd(1.0).solve(one_unknown(1e-300, 1e-300)).weights(0, 0) == doctest::Approx(1.0));
}

TEST_CASE("bad input is refused") {
  CHECK_THROWS_AS(truncated_svd(0.0), gonio::error);
  CHECK_THROWS_AS(truncated_svd(-0.5), gonio::error);
  CHECK_THROWS_AS(truncated_svd(1.0 + 1e-12), gonio::error);
  CHECK_THROWS_AS(truncated_svd(std::nan("")), gonio::error);
  for (const Eigen::Index n : {2, 5}) {
    const gonio::row_source broken{n, 3, [](gonio::block, gonio::row_block out) {
                                     out.setOnes();
                                     out(1, 2) = std::numeric_limits<double>::quiet_NaN();
                                   }};
    CHECK_THROWS_AS(truncated_svd().solve(least_squares_problem(broken, Eigen::MatrixXd::Ones(n, 1))), gonio::error);
  }
}
