#include <gonio/solve/normal_equations.hpp>

#include <doctest/doctest.h>

#include <cmath>

using gonio::normal_equations;

namespace {

const Eigen::MatrixXd& five_columns() {
  static const Eigen::MatrixXd a = Eigen::MatrixXd::Random(20, 5);
  return a;
}

}  // namespace

TEST_CASE("objective and residual are those of the rows") {
  const Eigen::MatrixXd& a = five_columns();
  const Eigen::VectorXd b = Eigen::VectorXd::Random(20), x = Eigen::VectorXd::Random(5);
  const normal_equations normal(a.transpose() * a, a.transpose() * b, Eigen::VectorXd::Constant(1, b.squaredNorm()));
  CHECK(normal.objective(x)[0] == doctest::Approx(0.5 * (a * x - b).squaredNorm() - 0.5 * b.squaredNorm()));
  CHECK(normal.residual(x)[0] == doctest::Approx((a * x - b).norm()));
}

TEST_CASE("the sum of two problems is that of the rows of both") {
  const Eigen::MatrixXd& a = five_columns();
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(20, 2), top = a.topRows(12), bottom = a.bottomRows(8);
  const auto normal = [](const Eigen::MatrixXd& rows, const Eigen::MatrixXd& right) {
    return normal_equations(rows.transpose() * rows, rows.transpose() * right, right.colwise().squaredNorm());
  };
  const normal_equations both = normal(top, b.topRows(12)) + normal(bottom, b.bottomRows(8)), all = normal(a, b);
  CHECK(both.gram().isApprox(all.gram(), 1e-14));
  CHECK(both.rhs().isApprox(all.rhs(), 1e-14));
  CHECK(both.rhs_squared_norm().isApprox(all.rhs_squared_norm(), 1e-14));
  CHECK_THROWS_WITH_AS(static_cast<void>(all + normal(top.leftCols(4), b.topRows(12))),
                       doctest::Contains("cannot be added"), gonio::error);
}

TEST_CASE("leaving a column out is a submatrix of the whole's products") {
  const Eigen::MatrixXd& a = five_columns();
  const Eigen::MatrixXd gram = a.transpose() * a;
  const auto columns = gonio::all_but(5, 2);
  CHECK(columns == std::vector<Eigen::Index>{0, 1, 3, 4});
  const auto problem = gonio::leave_one_out(gram, 2, columns);
  CHECK(problem.unknowns() == 4);
  CHECK(problem.gram()(1, 2) == gram(1, 3));
  CHECK(problem.rhs()(3, 0) == gram(4, 2));
  CHECK(problem.rhs_squared_norm()[0] == gram(2, 2));
}

TEST_CASE("normal equations that cannot be solved are refused with the offending column") {
  const auto refuse = [](Eigen::MatrixXd gram, Eigen::MatrixXd rhs, Eigen::VectorXd rhs_squared_norm,
                         const char* words) {
    CHECK_THROWS_WITH_AS(normal_equations(gram, rhs, rhs_squared_norm), doctest::Contains(words), gonio::error);
  };
  const Eigen::MatrixXd good = Eigen::MatrixXd::Identity(3, 3), right = Eigen::MatrixXd::Ones(3, 1);
  refuse(Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 1), {}, "empty");
  refuse(good, Eigen::MatrixXd(3, 0), {}, "empty");
  refuse(Eigen::MatrixXd::Ones(3, 2), right, {}, "3 x 2");
  refuse(good, Eigen::MatrixXd::Ones(2, 1), {}, "2 x 1");
  refuse(good, right, Eigen::VectorXd::Ones(2), "and there are 2 squared norms of right-hand sides");
  Eigen::MatrixXd broken = good;
  broken(0, 2) = std::nan("");
  refuse(broken, right, {}, "column 2");
  refuse(good, Eigen::Vector3d(0, std::numeric_limits<double>::infinity(), 0), {}, "column 1");
  broken = good;
  broken(1, 1) = -1;
  refuse(broken, right, {}, "column 1");
  refuse(good, right, Eigen::VectorXd::Constant(1, std::nan("")), "right-hand side");
}
