#include "../dense_reference.hpp"
#include "random_problems.hpp"
#include <gonio/core/error.hpp>
#include <gonio/solve/singular_values.hpp>

#include <Eigen/Core>
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>

namespace {

/// Returns the largest difference from Eigen's values, relative to the largest value.
double off_from_reference(const Eigen::MatrixXd& a, double scale = 1.0) {
  const Eigen::VectorXd found = gonio::singular_values(scale * a, "a test"), wanted = dense_reference::svd(a).values;
  return (found / scale - wanted.reverse()).cwiseAbs().maxCoeff() / wanted[0];
}

/// An n x k matrix whose singular values are 1, q, q^2, ... down to the smallest.
Eigen::MatrixXd graded(Eigen::Index n, Eigen::Index k, double smallest, unsigned seed) {
  const Eigen::Index rank = std::min(n, k);
  const Eigen::MatrixXd u = dense_reference::orthonormal_columns(random_matrix(n, rank, seed)),
                        v = dense_reference::orthonormal_columns(random_matrix(k, rank, seed + 1));
  Eigen::VectorXd values(rank);
  for (Eigen::Index i = 0; i < rank; ++i)
    values[i] = rank == 1 ? 1.0 : std::pow(smallest, static_cast<double>(i) / static_cast<double>(rank - 1));
  return u * values.asDiagonal() * v.transpose();
}

}  // namespace

TEST_CASE("singular values of tall, square and wide matrices of any scale are those of Eigen's Jacobi iteration") {
  CHECK(rc::check([] {
    const Eigen::Index n = *rc::gen::inRange(1, 40), k = *rc::gen::inRange(1, 40);
    const auto seed = static_cast<unsigned>(*rc::gen::inRange(0, 10'000));
    const double scale = std::pow(10.0, *rc::gen::inRange(-280, 280));
    Eigen::MatrixXd a = random_matrix(n, k, seed);
    if (*rc::gen::arbitrary<bool>()) a.col(k - 1) = a.col(0);
    RC_ASSERT(off_from_reference(a, scale) < gonio::singular_value_rounding(std::min(n, k)));
  }));
}

TEST_CASE("each value is good to rounding of the largest, which its square would not be") {
  for (const double smallest : {1e-3, 1e-8, 1e-12, 1e-14})
    for (const auto& [n, k] : {std::pair{30, 30}, {200, 40}, {12, 90}}) {
      CAPTURE(smallest);
      const Eigen::VectorXd values = gonio::singular_values(graded(n, k, smallest, 3), "a test");
      const double rounding = gonio::singular_value_rounding(values.size());
      CHECK(rounding < 4e-14);
      CHECK(std::abs(values[values.size() - 1] - 1.0) < rounding);
      CHECK(std::abs(values[0] - smallest) < rounding);
      CHECK(off_from_reference(graded(n, k, smallest, 3)) < rounding);
    }
}

TEST_CASE("ranks that are not full, zeros, and a bidiagonal matrix") {
  CHECK(gonio::singular_values(Eigen::MatrixXd::Zero(4, 3), "a test") == Eigen::VectorXd::Zero(3));
  CHECK(gonio::singular_values(Eigen::MatrixXd(0, 3), "a test").size() == 0);
  const Eigen::VectorXd along = Eigen::VectorXd::LinSpaced(9, -1.0, 2.0);
  const Eigen::VectorXd one = gonio::singular_values(along * along.transpose(), "a test");
  CHECK(one[8] == doctest::Approx(along.squaredNorm()).epsilon(gonio::singular_value_rounding(9)));
  CHECK(one[7] <= gonio::singular_value_rounding(9) * one[8]);
  CHECK(off_from_reference(Eigen::MatrixXd::Identity(6, 6)) < gonio::singular_value_rounding(6));
  Eigen::MatrixXd bidiagonal = Eigen::MatrixXd::Identity(5, 5);
  bidiagonal.diagonal(1).setConstant(-3.0);
  CHECK(off_from_reference(bidiagonal) < gonio::singular_value_rounding(5));
}

TEST_CASE("numbers that are not finite are refused by name") {
  for (const double odd : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Eigen::MatrixXd a = random_matrix(4, 3, 1);
    a(2, 1) = odd;
    CHECK_THROWS_WITH_AS((void)gonio::singular_values(a, "the plan"),
                         "the singular values of the plan are undefined: a value is not finite", gonio::error);
  }
}
