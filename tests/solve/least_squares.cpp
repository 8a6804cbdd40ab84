#include "../dense_reference.hpp"
#include "random_problems.hpp"
#include <gonio/solve/least_squares.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <random>

using gonio::least_squares;
using gonio::least_squares_problem;
using gonio::normal_equations;
using gonio::row_matrix;

namespace {

/// Returns a matrix with orthonormal columns.
Eigen::MatrixXd random_orthonormal(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  return dense_reference::orthonormal_columns(random_matrix(rows, columns, seed));
}

/// Returns weights, about every fifth of which is zero.
Eigen::VectorXd random_weights(Eigen::Index rows, unsigned seed) {
  return random_matrix(rows, 1, seed).unaryExpr([](double value) {
    return value < -0.8 ? 0.0 : std::abs(value) + 0.1;
  });
}

/// A problem of any shape. Some columns are copies or sums of others, or zero.
Eigen::MatrixXd random_dependent(Eigen::Index n, Eigen::Index k, unsigned seed) {
  Eigen::MatrixXd rows = random_matrix(n, k, seed);
  std::mt19937 generator(seed);
  const auto any = [&] { return generator() % static_cast<unsigned>(k); };
  for (Eigen::Index times = any() / 2; times > 0; --times) {
    const Eigen::Index to = any();
    const Eigen::MatrixXd first = rows.col(any()), second = rows.col(any());
    switch (generator() % 3) {
      case 0:
        rows.col(to) = first;
        break;
      case 1:
        rows.col(to) = first - 2.0 * second;
        break;
      default:
        rows.col(to).setZero();
    }
  }
  return rows;
}

struct reference {
  Eigen::MatrixXd x;
  double condition;
  Eigen::Index rank;
};

/// The minimum-norm solution by the singular value decomposition, from the eigenvectors of [0 A; A' 0].
reference by_svd(const least_squares_problem& problem) {
  const Eigen::Index n = problem.equations(), k = problem.unknowns(), r = problem.right_hand_side().cols();
  const Eigen::VectorXd root = problem.weights().cwiseSqrt();
  Eigen::MatrixXd both = Eigen::MatrixXd::Zero(n + k, n + k), right = Eigen::MatrixXd::Zero(n + k, r);
  both.topRightCorner(n, k) = root.asDiagonal() * problem.rows();
  both.bottomLeftCorner(k, n) = both.topRightCorner(n, k).transpose();
  right.topRows(n) = root.asDiagonal() * problem.right_hand_side();
  const auto eigen = dense_reference::symmetric_eigen(both);
  const double largest = eigen.values[n + k - 1];
  reference found{Eigen::MatrixXd::Zero(n + k, r), 1.0, 0};
  for (Eigen::Index i = 0; i < n + k; ++i) {
    const double value = eigen.values[i];
    if (std::abs(value) <= 1e-10 * largest) continue;
    const Eigen::VectorXd vector = eigen.vectors.col(i);
    for (Eigen::Index column = 0; column < r; ++column)
      found.x.col(column) += vector * (vector.dot(right.col(column)) / value);
    found.condition = std::max(found.condition, largest / std::abs(value));
    if (value > 0.0) ++found.rank;
  }
  found.x = Eigen::MatrixXd(found.x.bottomRows(k));
  return found;
}

}  // namespace

TEST_CASE("the minimum-norm solution is that of the singular value decomposition, for any shape and rank") {
  CHECK(rc::check([] {
    const auto n = *rc::gen::inRange<Eigen::Index>(1, 25), k = *rc::gen::inRange<Eigen::Index>(1, 25);
    const auto seed = *rc::gen::arbitrary<unsigned>();
    const least_squares_problem problem(random_dependent(n, k, seed), random_matrix(n, 2, seed + 1),
                                        random_weights(n, seed + 2));
    const auto expected = by_svd(problem);
    const double tolerance = 1e-13 * expected.condition * expected.condition;
    RC_PRE(tolerance < 1e-6);
    const auto found = least_squares().solve(problem);
    RC_ASSERT(least_squares().rank(problem) == expected.rank);
    RC_ASSERT(relative_distance(found.weights, expected.x) < tolerance);
    RC_ASSERT(found.report.kkt_residual.maxCoeff() < 1e-13);
    RC_ASSERT(found.report.iterations == 0);
    RC_ASSERT(relative_distance(found.report.residual, problem.residual(expected.x)) < 1e-12 * expected.condition);
    RC_ASSERT(relative_distance(found.report.objective, problem.normal().objective(expected.x)) <
              1e-12 * expected.condition);
  }));
}

TEST_CASE("the normal equations alone give the same, where their Gram matrix can tell") {
  CHECK(rc::check([] {
    const auto n = *rc::gen::inRange<Eigen::Index>(1, 25), k = *rc::gen::inRange<Eigen::Index>(1, 25);
    const auto seed = *rc::gen::arbitrary<unsigned>();
    const least_squares_problem problem(random_dependent(n, k, seed), random_matrix(n, 2, seed + 1),
                                        random_weights(n, seed + 2));
    const auto expected = by_svd(problem);
    RC_PRE(expected.condition < 1e4);
    const auto found = least_squares().solve(problem.normal());
    RC_ASSERT(least_squares().rank(problem.normal()) == expected.rank);
    RC_ASSERT(relative_distance(found.weights, expected.x) < 1e-12 * expected.condition * expected.condition);
    RC_ASSERT(found.report.kkt_residual.maxCoeff() < 1e-9);
  }));
}

TEST_CASE("closed forms: a column of ones gives the weighted mean, a row of ones shares it equally") {
  const least_squares_problem mean(row_matrix::Ones(3, 1), Eigen::Vector3d(1, 4, 100), Eigen::Vector3d(2, 1, 0));
  const auto found = least_squares().solve(mean);
  CHECK(found.weights(0, 0) == doctest::Approx(2.0));
  CHECK(found.report.residual[0] == doctest::Approx(std::sqrt(2.0 * 1.0 + 4.0)));
  CHECK(found.report.objective[0] == doctest::Approx(0.5 * (6.0 - 18.0)));

  const auto shared =
      least_squares().solve(least_squares_problem{row_matrix::Ones(1, 4), Eigen::MatrixXd::Constant(1, 1, 8.0)});
  CHECK(shared.weights.isApprox(Eigen::MatrixXd::Constant(4, 1, 2.0)));
}

TEST_CASE("more rows than the buffer holds: the triangle is that of all rows at once") {
  // With 6 columns the buffer of rows holds 1030.
  for (const Eigen::Index n : {1024, 1030, 1031, 2054, 4500}) {
    CAPTURE(n);
    Eigen::MatrixXd rows = random_matrix(n, 5, 7);
    const Eigen::VectorXd weights = random_weights(n, 9);
    const least_squares_problem problem(rows, random_matrix(n, 1, 8), weights);
    const Eigen::MatrixXd triangle = gonio::detail::triangular_equations(problem);
    REQUIRE(triangle.rows() == 6);
    const Eigen::MatrixXd left = triangle.leftCols(5);
    CHECK((left.transpose() * left).isApprox(problem.normal().gram(), 1e-13));
    CHECK((left.transpose() * triangle.col(5)).isApprox(problem.normal().rhs(), 1e-12));
    const auto found = least_squares().solve(problem);
    CHECK((problem.normal().gram() * found.weights).isApprox(problem.normal().rhs(), 1e-12));
    CHECK(found.report.kkt_residual[0] < 1e-14);

    rows.col(3) = rows.col(1) - 1e-3 * rows.col(2);
    CHECK(least_squares().rank(least_squares_problem{rows, random_matrix(n, 1, 8), weights}) == 4);
  }
}

TEST_CASE("the buffer also holds more columns than blocks have rows") {
  const Eigen::MatrixXd rows = random_matrix(1100, 6, 1) * random_matrix(6, 1100, 2);
  const least_squares_problem problem(rows, random_matrix(1100, 1, 3));
  CHECK(gonio::detail::triangular_equations(problem).rows() == 1100);
}

TEST_CASE("the rows have digits that the Gram matrix has lost: the matrix of Laeuchli") {
  const double small = 1e-9;  // 1 + small^2 is 1
  Eigen::MatrixXd rows(3, 2);
  rows << 1, 1, small, 0, 0, small;
  const least_squares_problem problem(rows, Eigen::Vector3d(3, small, 2 * small));
  const auto found = least_squares().solve(problem);
  CHECK(relative_distance(found.weights, Eigen::Vector2d(1, 2)) < 1e-6);
  CHECK(least_squares().rank(problem) == 2);
  CHECK(least_squares().rank(problem.normal()) == 1);
  CHECK(relative_distance(least_squares().solve(problem.normal()).weights, Eigen::Vector2d(1.5, 1.5)) < 1e-12);
}

TEST_CASE("a condition number of 1e14") {
  const Eigen::Index n = 60, k = 12;
  Eigen::VectorXd singular(k);
  for (Eigen::Index j = 0; j < k; ++j) singular[j] = std::pow(10.0, -14.0 * static_cast<double>(j) / (k - 1));
  const Eigen::MatrixXd rows =
      random_orthonormal(n, k, 1) * singular.asDiagonal() * random_orthonormal(k, k, 2).transpose();
  const Eigen::VectorXd weights = random_matrix(n, 1, 3).cwiseAbs();

  SUBCASE("equations that can be met are met, with or without truncation") {
    const Eigen::MatrixXd right = rows * random_matrix(k, 3, 4);
    for (const double threshold : {0.0, 1e-15, 1e-12}) {
      const auto found = least_squares(threshold).solve(least_squares_problem{rows, right, weights});
      CHECK(found.report.residual.maxCoeff() < 10.0 * std::max(threshold, 1e-15));
      CHECK(found.report.kkt_residual.maxCoeff() < 1e-12);
    }
  }
  SUBCASE("what truncation leaves in the gradient is below the threshold") {
    for (const double threshold : {1e-12, 1e-10}) {
      const least_squares_problem problem(rows, random_matrix(n, 3, 5), weights);
      CHECK(least_squares(threshold).rank(problem) < k);
      CHECK(least_squares(threshold).solve(problem).report.kkt_residual.maxCoeff() < threshold);
    }
    const least_squares_problem problem(rows, random_matrix(n, 3, 5), weights);
    CHECK(least_squares().solve(problem.normal()).report.kkt_residual.maxCoeff() < least_squares::gram_threshold);
  }
}

TEST_CASE("neither the rank nor the solution depends on the units of the columns, if there is but one") {
  const Eigen::Index n = 30, k = 6;
  const Eigen::MatrixXd rows = random_matrix(n, k, 1);
  const Eigen::MatrixXd right = random_matrix(n, 2, 2);
  Eigen::VectorXd units(k);
  units << 1e-150, 1e-20, 1.0, 1e7, 1e20, 1e100;
  const Eigen::MatrixXd scaled = rows * units.asDiagonal();
  const Eigen::MatrixXd expected = least_squares().solve(least_squares_problem{rows, right}).weights;
  const auto found = least_squares().solve(least_squares_problem{scaled, right});
  CHECK((units.asDiagonal() * found.weights).isApprox(expected, 1e-12));
  CHECK(found.report.kkt_residual.maxCoeff() < 1e-14);
  const auto by_gram = least_squares().solve(least_squares_problem(scaled, right).normal());
  CHECK((units.asDiagonal() * by_gram.weights).isApprox(expected, 1e-12));
}

TEST_CASE("dependent columns of very different lengths still leave no gradient") {
  Eigen::MatrixXd rows = random_matrix(30, 6, 1);
  rows.col(5) = rows.col(0) + rows.col(1);
  rows.col(1) *= 1e-6;
  rows.col(2) *= 1e6;
  const least_squares_problem problem(rows, random_matrix(30, 2, 2));
  CHECK(least_squares().rank(problem) == 5);
  CHECK(least_squares().solve(problem).report.kkt_residual.maxCoeff() < 1e-9);
  CHECK(least_squares().rank(problem.normal()) == 5);
  CHECK(least_squares().solve(problem.normal()).report.kkt_residual.maxCoeff() < 1e-9);
}

TEST_CASE("nothing to fit: no weight, no matrix, no right-hand side, or one orthogonal to all columns") {
  const Eigen::MatrixXd rows = random_matrix(8, 3, 1);
  const Eigen::MatrixXd right = random_matrix(8, 1, 2);
  const least_squares_problem problems[] = {
      {rows, right, Eigen::VectorXd::Zero(8)}, {row_matrix::Zero(8, 3), right}, {rows, Eigen::MatrixXd::Zero(8, 1)}};
  for (const least_squares_problem& problem : problems) {
    CHECK(least_squares().solve(problem).weights.isZero(0.0));
    CHECK(least_squares().solve(problem).report.kkt_residual[0] == 0.0);
    CHECK(least_squares().solve(problem.normal()).weights.isZero(0.0));
    CHECK(least_squares().solve(problem.normal()).report.kkt_residual[0] == 0.0);
  }
  const Eigen::MatrixXd columns = random_orthonormal(8, 4, 3);
  const auto orthogonal = least_squares().solve(least_squares_problem{columns.leftCols(3), columns.rightCols(1)});
  CHECK(orthogonal.weights.cwiseAbs().maxCoeff() < 1e-15);
  CHECK(orthogonal.report.kkt_residual[0] < 1e-15);
}

TEST_CASE("the KKT residual of other weights is not small") {
  const least_squares_problem problem(random_matrix(2000, 5, 1), random_matrix(2000, 1, 2));
  Eigen::MatrixXd x = least_squares().solve(problem).weights;
  CHECK(gonio::detail::stationarity_of_rows(problem, x)[0] < 1e-14);
  x(2, 0) += 1e-6;
  CHECK(gonio::detail::stationarity_of_rows(problem, x)[0] > 1e-8);
}

TEST_CASE("a subset of the columns") {
  const Eigen::MatrixXd rows = random_matrix(20, 5, 1);
  const Eigen::MatrixXd right = random_matrix(20, 1, 2);
  Eigen::MatrixXd chosen(20, 2);
  chosen << rows.col(4), rows.col(1);
  const Eigen::Index columns[] = {4, 1};
  CHECK(least_squares()
            .solve(least_squares_problem(rows, right).subset(columns))
            .weights.isApprox(least_squares().solve(least_squares_problem{chosen, right}).weights, 1e-14));
}

TEST_CASE("bad input is refused") {
  CHECK_THROWS_AS(least_squares(-1e-9), gonio::error);
  CHECK_THROWS_AS(least_squares(1.0), gonio::error);
  CHECK_THROWS_AS(least_squares(std::nan("")), gonio::error);
  const gonio::row_source broken{2000, 1, [](gonio::block range, gonio::row_block out) {
                                   for (Eigen::Index row = 0; row < out.rows(); ++row)
                                     out(row, 0) =
                                         range.begin + row == 1500 ? std::numeric_limits<double>::infinity() : 1.0;
                                 }};
  const least_squares_problem problem(broken, Eigen::MatrixXd::Ones(2000, 1));
  CHECK_THROWS_WITH_AS(least_squares().solve(problem), "row 1500 of a least-squares problem is not finite in column 0",
                       gonio::error);
}
