#include "../dense_reference.hpp"
#include <gonio/core/error.hpp>
#include <gonio/solve/symmetric_eigen.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <random>

namespace {

Eigen::MatrixXd random_symmetric(Eigen::Index size, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd a(size, size);
  for (Eigen::Index j = 0; j < size; ++j)
    for (Eigen::Index i = j; i < size; ++i) a(i, j) = a(j, i) = normal(generator);
  return a;
}

/// Checks that A V = V diag(values), that V is orthonormal, and that the values equal those of Eigen's solver.
void check_decomposition(const Eigen::MatrixXd& a) {
  const gonio::symmetric_eigen found = gonio::decompose_symmetric(a, "a test");
  const double size = std::max(a.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  const auto n = static_cast<double>(a.rows());
  const Eigen::MatrixXd scaled = a / size, values = (found.values / size).asDiagonal();
  CHECK((scaled * found.vectors - found.vectors * values).cwiseAbs().maxCoeff() < 1e-14 * n);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(a.rows(), a.rows());
  CHECK((found.vectors.transpose() * found.vectors - identity).cwiseAbs().maxCoeff() < 1e-14 * n);
  const auto reference = dense_reference::symmetric_eigen(scaled);
  CHECK((found.values / size - reference.values).cwiseAbs().maxCoeff() < 1e-14 * n);
  CHECK((gonio::symmetric_eigenvalues(a, "a test") - found.values).cwiseAbs().maxCoeff() <= 1e-14 * n * size);
}

}  // namespace

TEST_CASE("eigenvalues and eigenvectors of random symmetric matrices") {
  CHECK(rc::check([] {
    const Eigen::Index size = *rc::gen::inRange(1, 40);
    check_decomposition(random_symmetric(size, *rc::gen::arbitrary<std::uint64_t>()));
  }));
  check_decomposition(random_symmetric(200, 1));
}

TEST_CASE("eigenvalues that are equal, zero or far apart") {
  check_decomposition(Eigen::MatrixXd::Identity(7, 7));
  check_decomposition(Eigen::MatrixXd::Zero(5, 5));
  const Eigen::VectorXd direction = Eigen::VectorXd::LinSpaced(9, -1.0, 2.0);
  check_decomposition(direction * direction.transpose());
  const Eigen::VectorXd powers =
      Eigen::VectorXd::LinSpaced(12, -14.0, 0.0).unaryExpr([](double x) { return std::pow(10.0, x); });
  const Eigen::MatrixXd turn = gonio::decompose_symmetric(random_symmetric(12, 3), "a test").vectors;
  check_decomposition(turn * powers.asDiagonal() * turn.transpose());
}

TEST_CASE("entries whose squares are out of range") {
  check_decomposition(1e200 * random_symmetric(6, 4));
  check_decomposition(1e-200 * random_symmetric(6, 5));
}

TEST_CASE("only the lower triangle is read") {
  Eigen::MatrixXd a = random_symmetric(8, 6);
  const Eigen::VectorXd values = gonio::symmetric_eigenvalues(a, "a test");
  a.triangularView<Eigen::StrictlyUpper>().setConstant(1e300);
  CHECK((gonio::symmetric_eigenvalues(a, "a test") - values).cwiseAbs().maxCoeff() == 0.0);
  CHECK((gonio::decompose_symmetric(a, "a test").values - values).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("numbers that are not finite are refused by name") {
  Eigen::MatrixXd a = random_symmetric(4, 7);
  a(2, 1) = std::nan("");
  CHECK_THROWS_WITH_AS((void)gonio::decompose_symmetric(a, "the Gram matrix"),
                       "the eigenvalues of the Gram matrix do not converge", gonio::error);
}
