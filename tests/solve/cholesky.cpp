#include <gonio/solve/cholesky.hpp>

#include <Eigen/Cholesky>
#include <doctest/doctest.h>

#include <limits>

namespace {

/// Returns a symmetric positive definite matrix with eigenvalues of at least 1.
Eigen::MatrixXd positive_definite(Eigen::Index size) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(size, size + 3);
  return Eigen::MatrixXd::Identity(size, size) + a * a.transpose();
}

}  // namespace

// Sizes near multiples of 64, the number of columns factorised together, and of the tiles of products.
TEST_CASE("Cholesky factors are Eigen's") {
  for (const Eigen::Index size : {1, 2, 5, 63, 64, 65, 127, 128, 129, 200}) {
    CAPTURE(size);
    const Eigen::MatrixXd a = positive_definite(size), b = Eigen::MatrixXd::Random(size, 3);
    const gonio::cholesky factors(a);
    const Eigen::LLT<Eigen::MatrixXd> expected(a);
    CHECK(factors.positive_definite());
    CHECK(factors.solve(b).isApprox(expected.solve(b), 1e-11));
    CHECK(factors.solve_lower(b).isApprox(expected.matrixL().solve(b), 1e-12));
    CHECK(factors.solve_upper(b).isApprox(expected.matrixU().solve(b), 1e-12));
    CHECK(factors.inverse().isApprox(expected.solve(Eigen::MatrixXd::Identity(size, size)), 1e-11));
    CHECK(factors.log_determinant() ==
          doctest::Approx(2.0 * expected.matrixLLT().diagonal().array().log().sum()).epsilon(1e-12));
    Eigen::VectorXd column = b.col(0);
    factors.solve_lower_in_place(column.data());
    CHECK(column.isApprox(factors.solve_lower(b).col(0), 1e-12));
  }
}

TEST_CASE("only the lower triangle is read") {
  const Eigen::MatrixXd a = positive_definite(70), b = Eigen::MatrixXd::Random(70, 2);
  Eigen::MatrixXd lower = a.triangularView<Eigen::Lower>();
  lower.triangularView<Eigen::StrictlyUpper>().setConstant(std::numeric_limits<double>::quiet_NaN());
  CHECK(gonio::cholesky(lower).solve(b) == gonio::cholesky(a).solve(b));
}

TEST_CASE("a matrix that is not positive definite is found out, in the first columns and in the last") {
  for (const Eigen::Index at : {0, 63, 64, 149}) {
    CAPTURE(at);
    for (const double wrong : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
      Eigen::MatrixXd a = positive_definite(150);
      a(at, at) = wrong;
      CHECK_FALSE(gonio::cholesky(a).positive_definite());
    }
  }
}

TEST_CASE("A A' is Eigen's product, also of a block of a matrix") {
  const Eigen::MatrixXd whole = Eigen::MatrixXd::Random(260, 300);
  for (const Eigen::Index rows : {1, 3, 4, 47, 48, 49, 97, 250})
    for (const Eigen::Index columns : {1, 5, 127, 128, 129, 290}) {
      CAPTURE(rows);
      CAPTURE(columns);
      const auto a = whole.block(2, 3, rows, columns);
      CHECK(gonio::product_with_transpose(a).isApprox(a * a.transpose(), 1e-13));
    }
}
