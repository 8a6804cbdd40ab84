#include "dense_reference.hpp"
#include "synthetic_shapes.hpp"

#include <doctest/doctest.h>

#include <limits>

TEST_CASE("the components of shapes are the eigenvectors of their covariance (Eq. 1)") {
  const auto shapes = synthetic_shapes(6, 9, 4, 1);
  const gonio::shape::shape_basis basis = synthetic_basis(shapes);
  Eigen::MatrixXd x(18, 9);
  for (Eigen::Index i = 0; i < 9; ++i) x.col(i) = shapes[i].reshaped();
  const Eigen::VectorXd mean = x.rowwise().mean();
  x.colwise() -= mean;
  CHECK((gonio::shape::mean_shape(basis).reshaped() - mean).cwiseAbs().maxCoeff() < 1e-5);
  const auto eigen = dense_reference::symmetric_eigen(x * x.transpose() / 9.0);
  REQUIRE(basis.size() == 8);  // the mean takes one degree of freedom
  for (Eigen::Index i = 0; i < 8; ++i)
    CHECK(basis.singular_values()[i] * basis.singular_values()[i] / 9.0 ==
          doctest::Approx(eigen.values[17 - i]).epsilon(1e-4));
}

TEST_CASE("the weights of a shape that was learned from expand to it") {
  const auto shapes = synthetic_shapes(7, 5, 3, 2);
  const gonio::shape::shape_basis basis = synthetic_basis(shapes);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Eigen::MatrixXd weights = basis.weights_of(i);
    REQUIRE(weights.cols() == 1);
    CHECK((gonio::shape::shape_of(basis, weights.col(0)) - shapes[i]).cwiseAbs().maxCoeff() < 2e-5);
  }
}

TEST_CASE("weights of the shapes learned from have the covariance I / m, so their squared distances have the mean k") {
  const gonio::shape::shape_basis basis = synthetic_basis(synthetic_shapes(20, 30, 10, 3));
  double sum = 0.0;
  for (std::size_t i = 0; i < 30; ++i) sum += gonio::shape::squared_mahalanobis(basis, basis.weights_of(i).col(0));
  CHECK(sum / 30.0 == doctest::Approx(static_cast<double>(basis.size())).epsilon(1e-4));
}

TEST_CASE("a share of the variance keeps the fewest components that have it") {
  const gonio::shape::shape_basis basis = synthetic_basis(synthetic_shapes(20, 30, 10, 4));
  const Eigen::VectorXd squares = basis.singular_values().cwiseAbs2();
  const gonio::shape::shape_basis most = gonio::shape::truncated_to_variance(basis, 0.9);
  const Eigen::Index kept = std::ssize(most);
  CHECK(squares.head(kept).sum() >= 0.9 * squares.sum());
  CHECK(squares.head(kept - 1).sum() < 0.9 * squares.sum());
  CHECK(gonio::shape::truncated_to_variance(basis, 1.0).size() == basis.size());
  CHECK_THROWS_WITH_AS(gonio::shape::truncated_to_variance(basis, 0.0),
                       "the explained variance must be above 0 and at most 1, not 0.000000", gonio::error);
}

TEST_CASE("shapes that do not belong together are refused") {
  auto shapes = synthetic_shapes(4, 3, 2, 5);
  CHECK_THROWS_WITH_AS(gonio::shape::shape_set::of(shapes, synthetic_names(2)),
                       doctest::Contains("3 shapes and 2 names"), gonio::error);
  CHECK_THROWS_WITH_AS(gonio::shape::shape_set::of({}, {}), doctest::Contains("0 shapes"), gonio::error);
  shapes[1].conservativeResize(3, 3);
  CHECK_THROWS_WITH_AS(gonio::shape::shape_set::of(shapes, synthetic_names(3)),
                       "shape 'shape-1' has 3 vertices, expected 4 as 'shape-0' has", gonio::error);
  shapes = synthetic_shapes(4, 3, 2, 5);
  shapes[2](1, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS(gonio::shape::shape_set::of(shapes, synthetic_names(3)),
                       "shape 'shape-2' has a vertex that is not finite", gonio::error);
  const auto same = std::vector<gonio::shape::point_columns>(3, synthetic_shapes(4, 1, 2, 5)[0]);
  CHECK_THROWS_AS(synthetic_basis(same), gonio::error);
}
