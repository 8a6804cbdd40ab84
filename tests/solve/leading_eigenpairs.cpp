#include <gonio/core/error.hpp>
#include <gonio/solve/leading_eigenpairs.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace {

/// A random rotation of a diagonal matrix with the eigenvalues 1, factor, factor^2, ...
Eigen::MatrixXd falling_matrix(Eigen::Index size, double factor) {
  std::srand(5);
  const Eigen::MatrixXd random = Eigen::MatrixXd::Random(size, size);
  const Eigen::MatrixXd rotation = gonio::decompose_leading(random * random.transpose(), size, "a test").vectors;
  Eigen::VectorXd values(size);
  for (Eigen::Index i = 0; i < size; ++i) values[i] = std::pow(factor, double(i));
  return rotation * values.asDiagonal() * rotation.transpose();
}

gonio::matrix_times times(const Eigen::MatrixXd& matrix) {
  return [&matrix](const Eigen::MatrixXd& vectors, bool) -> Eigen::MatrixXd { return matrix * vectors; };
}

}  // namespace

TEST_CASE("the largest eigenvalues of a matrix that is held, without those that are rounding") {
  const Eigen::MatrixXd matrix = falling_matrix(40, 0.5);
  const auto found = gonio::decompose_leading(matrix, 6, "a test");
  for (Eigen::Index i = 0; i < 6; ++i) {
    CHECK(found.values[i] == doctest::Approx(std::pow(0.5, double(i))).epsilon(1e-12));
    CHECK((matrix * found.vectors.col(i)).isApprox(found.values[i] * found.vectors.col(i), 1e-12));
    CHECK(found.vectors.col(i).maxCoeff() >= -found.vectors.col(i).minCoeff());
  }
  CHECK(gonio::decompose_leading(falling_matrix(40, 1e-3), 40, "a test").values.size() < 8);
  CHECK(gonio::decompose_leading(Eigen::MatrixXd::Zero(4, 4), 4, "a test").values.size() == 0);
}

TEST_CASE("eigenpairs by products with random vectors are within their residual of the exact ones") {
  for (const double factor : {0.5, 0.9, 0.99}) {
    const Eigen::MatrixXd matrix = falling_matrix(120, factor);
    const auto exact = gonio::decompose_leading(matrix, 8, "a test");
    const auto found = gonio::iterate_leading(120, 8, {.oversampling = 20, .products = 3, .seed = 3}, times(matrix));
    CAPTURE(factor);
    CHECK((found.pairs.values - exact.values).cwiseAbs().maxCoeff() <= found.pairs.residual + 1e-14);
    CHECK((found.pairs.vectors.transpose() * found.pairs.vectors).isIdentity(1e-12));
    CHECK((matrix * found.pairs.vectors - found.pairs.vectors * found.pairs.values.asDiagonal()).norm() ==
          doctest::Approx(found.pairs.residual).epsilon(1e-6));
    if (factor < 0.95) CHECK((found.pairs.values - exact.values).cwiseAbs().maxCoeff() < 1e-3);
  }
}

TEST_CASE("the same seed gives the same eigenpairs, more products better ones") {
  const Eigen::MatrixXd matrix = falling_matrix(120, 0.95);
  const auto residual = [&](int products, std::uint64_t seed) {
    return gonio::iterate_leading(120, 8, {.oversampling = 10, .products = products, .seed = seed}, times(matrix))
        .pairs.residual;
  };
  CHECK(residual(3, 1) == residual(3, 1));
  CHECK(residual(3, 1) != residual(3, 2));
  CHECK(residual(4, 1) < residual(2, 1));
  CHECK(residual(2, 1) < residual(1, 1));
}

TEST_CASE("seeds stand for the same random vectors everywhere") {
  // Computed by another program from three vectors of six normal numbers (Box and Muller, from the standard's
  // generator).
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(6, 6);
  for (Eigen::Index i = 0; i < 6; ++i) matrix(i, i) = std::pow(0.5, double(i));
  const auto of_seed = [&](std::uint64_t seed) {
    return gonio::iterate_leading(6, 2, {.oversampling = 1, .products = 1, .seed = seed}, times(matrix)).pairs;
  };
  CHECK(of_seed(1).values[0] == doctest::Approx(0.3840221404243473).epsilon(1e-12));
  CHECK(of_seed(1).values[1] == doctest::Approx(0.2562499536053607).epsilon(1e-12));
  CHECK(of_seed(1).residual == doctest::Approx(0.47536292922602164).epsilon(1e-12));
  CHECK(of_seed(2).values[0] == doctest::Approx(0.6126360998282263).epsilon(1e-12));
}

TEST_CASE("a subspace as wide as the matrix is exact, and impossible ones are refused") {
  const Eigen::MatrixXd matrix = falling_matrix(12, 0.7);
  const auto found = gonio::iterate_leading(12, 12, {}, times(matrix));
  CHECK(found.pairs.residual < 1e-13);
  CHECK(found.combination.rows() == 12);
  CHECK_THROWS_AS(gonio::iterate_leading(12, 0, {}, times(matrix)), gonio::error);
  CHECK_THROWS_AS(gonio::iterate_leading(12, 3, {.products = 0}, times(matrix)), gonio::error);
  CHECK_THROWS_AS(gonio::iterate_leading(12, 3, {.oversampling = -1}, times(matrix)), gonio::error);
}
