#include "random_problems.hpp"
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/householder_qr.hpp>

#include <Eigen/Core>
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>

namespace {

Eigen::MatrixXd triangle_of(const gonio::householder_qr& qr) {
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(qr.rows(), qr.cols());
  for (Eigen::Index column = 0; column < qr.cols(); ++column)
    for (Eigen::Index row = 0; row <= std::min(column, qr.rows() - 1); ++row)
      triangle(row, column) = qr.triangle(row, column);
  return triangle;
}

}  // namespace

TEST_CASE("Q R is A, Q is orthogonal, for tall, square and wide matrices of any scale") {
  CHECK(rc::check([] {
    const Eigen::Index n = *rc::gen::inRange(1, 30), k = *rc::gen::inRange(1, 30);
    const auto seed = static_cast<unsigned>(*rc::gen::inRange(0, 10'000));
    const double scale = std::pow(10.0, *rc::gen::inRange(-300, 300));
    Eigen::MatrixXd a = scale * random_matrix(n, k, seed);
    if (*rc::gen::arbitrary<bool>()) a.col(k - 1) = a.col(0);
    const gonio::householder_qr qr(a);
    Eigen::MatrixXd back = triangle_of(qr), q = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index column = 0; column < k; ++column) qr.apply(&back(0, column));
    RC_ASSERT(((back - a) / scale).norm() <= 1e-14 * (a / scale).norm());
    for (Eigen::Index column = 0; column < n; ++column) qr.apply(&q(0, column));
    RC_ASSERT((q.transpose() * q - Eigen::MatrixXd::Identity(n, n)).norm() <= 1e-13);
    for (Eigen::Index column = 0; column < n; ++column) qr.apply_transposed(&q(0, column));
    RC_ASSERT((q - Eigen::MatrixXd::Identity(n, n)).norm() <= 1e-13);
    for (Eigen::Index column = 0; column < k; ++column)
      RC_ASSERT(std::abs(qr.length(column) / scale - (a.col(column) / scale).norm()) <= 1e-13 * std::sqrt(n));
  }));
}

TEST_CASE("a column that depends on another, at the lower end of the numbers, leaves Q orthogonal") {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Eigen::MatrixXd a = 1e-300 * random_matrix(5, 2, seed), q = Eigen::MatrixXd::Identity(5, 5);
    a.col(1) = a.col(0);
    const gonio::householder_qr qr(a);
    for (Eigen::Index column = 0; column < 5; ++column) qr.apply(&q(0, column));
    CHECK((q.transpose() * q - Eigen::MatrixXd::Identity(5, 5)).norm() <= 1e-13);
  }
}

TEST_CASE("triangular systems") {
  const Eigen::MatrixXd a = random_matrix(12, 7, 1);
  const gonio::householder_qr qr(a);
  const Eigen::MatrixXd triangle = triangle_of(qr).topRows(7);
  const Eigen::VectorXd z = random_matrix(7, 1, 2);
  Eigen::VectorXd solved = z, transposed = z;
  qr.solve(solved.data());
  qr.solve_transposed(transposed.data());
  CHECK((triangle * solved).isApprox(z, 1e-13));
  CHECK((triangle.transpose() * transposed).isApprox(z, 1e-13));
}

TEST_CASE("zeros, and a matrix that is triangular already, are left as they are") {
  CHECK(triangle_of(gonio::householder_qr(Eigen::MatrixXd::Zero(4, 3))) == Eigen::MatrixXd::Zero(4, 3));
  const Eigen::MatrixXd upper = random_matrix(5, 5, 3).triangularView<Eigen::Upper>();
  CHECK(triangle_of(gonio::householder_qr(upper)) == upper);
}

TEST_CASE("norms of numbers whose squares are out of range") {
  const Eigen::Vector2d tiny(3e-300, 4e-300), large(3e300, -4e300), zero(0, 0);
  CHECK(gonio::norm(tiny.data(), 2) == doctest::Approx(5e-300).epsilon(1e-15));
  CHECK(gonio::norm(large.data(), 2) == doctest::Approx(5e300).epsilon(1e-15));
  CHECK(gonio::norm(zero.data(), 2) == 0.0);
  CHECK(gonio::norm(nullptr, 0) == 0.0);
  for (const double length : {1e-300, 0.3, 1.0, 7.0, 1e308}) {
    const double scaled = length * gonio::near_inverse(length);
    CHECK(scaled >= 0.5);
    CHECK(scaled < 1.0);
  }
  CHECK(gonio::near_inverse(0.0) == 1.0);
  CHECK(std::isfinite(gonio::near_inverse(std::numeric_limits<double>::denorm_min())));
}
