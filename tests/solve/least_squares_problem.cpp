#include <gonio/solve/least_squares_problem.hpp>

#include <doctest/doctest.h>

#include <limits>

using gonio::least_squares_problem;
using gonio::row_matrix;

TEST_CASE("normal equations and residuals are weighted, and copies share them") {
  const row_matrix rows = row_matrix::Random(7, 3);
  const Eigen::MatrixXd right = Eigen::MatrixXd::Random(7, 2);
  const Eigen::VectorXd weights = Eigen::VectorXd::Random(7).cwiseAbs();
  const least_squares_problem problem(rows, right, weights), copy = problem;
  CHECK(problem.normal().gram().isApprox(rows.transpose() * weights.asDiagonal() * rows, 1e-13));
  CHECK(problem.normal().rhs().isApprox(rows.transpose() * weights.asDiagonal() * right, 1e-13));
  CHECK(&copy.normal() == &problem.normal());

  const Eigen::MatrixXd x = Eigen::MatrixXd::Random(3, 2);
  double sum = 0;
  for (Eigen::Index i = 0; i < 7; ++i) sum += weights[i] * std::pow(rows.row(i).dot(x.col(1)) - right(i, 1), 2);
  CHECK(problem.residual(x)[1] == doctest::Approx(std::sqrt(sum)));
}

TEST_CASE("no weights means all ones") {
  const least_squares_problem problem(row_matrix::Ones(2, 1), Eigen::MatrixXd::Ones(2, 1));
  CHECK(problem.normal().gram()(0, 0) == 2.0);
}

TEST_CASE("unusable problems are refused with the offending row") {
  const auto refuse = [](row_matrix rows, Eigen::MatrixXd right, Eigen::VectorXd weights, const char* words) {
    CHECK_THROWS_WITH_AS(least_squares_problem(rows, right, weights), doctest::Contains(words), gonio::error);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  refuse(row_matrix(0, 3), Eigen::MatrixXd(0, 1), {}, "empty");
  refuse(row_matrix(3, 0), Eigen::MatrixXd::Ones(3, 1), {}, "empty");
  refuse(row_matrix::Ones(3, 2), Eigen::MatrixXd::Ones(2, 1), {}, "2 right-hand values");
  refuse(row_matrix::Ones(3, 2), Eigen::MatrixXd::Ones(3, 1), Eigen::VectorXd::Ones(4), "4 weights");
  row_matrix rows = row_matrix::Ones(3, 2);
  rows(1, 1) = nan;
  refuse(rows, Eigen::MatrixXd::Ones(3, 1), {}, "row 1");
  refuse(row_matrix::Ones(3, 2), Eigen::Vector3d(0, 0, nan), {}, "row 2");
  refuse(row_matrix::Ones(3, 2), Eigen::MatrixXd::Ones(3, 1), Eigen::Vector3d(1, -1, 1), "row 1");
}

TEST_CASE("rows that are only read give the same problem, and a row that is not finite is named") {
  const row_matrix rows = row_matrix::Random(3000, 5);
  const Eigen::MatrixXd right = Eigen::MatrixXd::Random(3000, 2);
  const Eigen::VectorXd weights = Eigen::VectorXd::Random(3000).cwiseAbs();
  const least_squares_problem kept(rows, right, weights), one({gonio::rows_of(rows), right, weights, {1}}),
      three({gonio::rows_of(rows), right, weights, {3}});
  CHECK(kept.rows() == rows);
  CHECK(kept.normal().gram().isApprox(rows.transpose() * weights.asDiagonal() * rows, 1e-13));
  CHECK(kept.normal().rhs_squared_norm()[1] ==
        doctest::Approx((right.col(1).transpose() * weights.asDiagonal() * right.col(1))(0)));
  CHECK(one.normal().gram() == three.normal().gram());
  CHECK(one.normal().rhs() == three.normal().rhs());
  CHECK(one.residual(Eigen::MatrixXd::Ones(5, 2)) == three.residual(Eigen::MatrixXd::Ones(5, 2)));

  row_matrix broken = rows;
  broken(2047, 3) = std::numeric_limits<double>::quiet_NaN();
  const least_squares_problem unread(gonio::rows_of(broken), right);
  CHECK_THROWS_WITH_AS(unread.normal(),
                       doctest::Contains("row 2047 of a least-squares problem is not finite in column 3"),
                       gonio::error);
}

TEST_CASE("whatever reads a row that is not finite refuses it by name, and large numbers are none") {
  constexpr double inf = std::numeric_limits<double>::infinity();
  row_matrix broken = row_matrix::Ones(3000, 4);
  broken(2047, 3) = inf;
  broken(2050, 3) = -inf;
  const least_squares_problem problem(gonio::rows_of(broken), Eigen::MatrixXd::Ones(3000, 1));
  const std::vector<Eigen::Index> last{3};
  const auto refused = [](const auto& read) {
    CHECK_THROWS_WITH_AS(read(), "row 2047 of a least-squares problem is not finite in column 3", gonio::error);
  };
  refused([&] { (void)problem.rows(); });
  refused([&] { (void)problem.weighted_rows(); });
  refused([&] { (void)problem.residual(Eigen::MatrixXd::Zero(4, 1)); });
  refused([&] { (void)problem.normal(); });
  refused([&] { (void)problem.subset(last).rows(); });
  // The sum of the elements overflows.
  CHECK(least_squares_problem(row_matrix::Constant(2, 2, 1e308), Eigen::MatrixXd::Ones(2, 1)).rows()(1, 1) == 1e308);
}

TEST_CASE("weighted equations are those of the rows of positive weight") {
  const row_matrix rows = row_matrix::Random(2000, 3);
  const Eigen::MatrixXd right = Eigen::MatrixXd::Random(2000, 2);
  Eigen::VectorXd weights = Eigen::VectorXd::Random(2000).cwiseAbs();
  weights.segment(1000, 500).setZero();
  const least_squares_problem problem(rows, right, weights);
  REQUIRE(problem.observations() == 1500);
  const row_matrix weighted = problem.weighted_rows();
  const Eigen::MatrixXd weighted_right = problem.weighted_right_hand_side();
  REQUIRE(weighted.rows() == 1500);
  REQUIRE(weighted_right.rows() == 1500);
  CHECK(weighted.row(1000) == std::sqrt(weights[1500]) * rows.row(1500));
  CHECK((weighted.transpose() * weighted).isApprox(problem.normal().gram(), 1e-13));
  CHECK((weighted.transpose() * weighted_right).isApprox(problem.normal().rhs(), 1e-13));
}

TEST_CASE("a subset of the columns, and a subset of that, share the rows and the products") {
  const row_matrix rows = row_matrix::Random(50, 6);
  const least_squares_problem whole(rows, Eigen::MatrixXd::Random(50, 1));
  const std::vector<Eigen::Index> chosen{4, 0, 5}, second{2, 0};
  const auto part = whole.subset(chosen), nested = part.subset(second);
  CHECK(part.unknowns() == 3);
  CHECK(part.rows().col(0) == rows.col(4));
  CHECK(part.normal().gram()(0, 2) == whole.normal().gram()(4, 5));
  CHECK(nested.rows().col(0) == rows.col(5));
  CHECK(nested.normal().gram()(0, 1) == whole.normal().gram()(5, 4));
  CHECK(nested.normal().rhs()(1, 0) == whole.normal().rhs()(4, 0));
  const Eigen::MatrixXd x = Eigen::MatrixXd::Random(3, 1);
  CHECK(part.residual(x)[0] == doctest::Approx(part.normal().residual(x)[0]));
  const std::vector<Eigen::Index> none, outside{3};
  CHECK_THROWS_AS(part.subset(none), gonio::error);
  CHECK_THROWS_AS(part.subset(outside), gonio::error);
}
