#include "synthetic_shapes.hpp"
#include <gonio/shape/shape_with_motion.hpp>

#include <doctest/doctest.h>

#include <cmath>

using gonio::shape::point_columns, gonio::shape::shape_with_motion;

namespace {

/// Returns every coordinate from the basis: offset + row . weights.
point_columns combined(const shape_with_motion& functions, const Eigen::VectorXd& weights) {
  point_columns shape(3, functions.cells().vertices);
  for (Eigen::Index coordinate = 0; coordinate < functions.cells().size(); ++coordinate) {
    double& value = shape.data()[coordinate];
    value = functions.offset(coordinate);
    const auto row = functions.row(coordinate);
    for (Eigen::Index i = 0; i < std::ssize(row); ++i) value += double{row[i]} * weights[i];
  }
  return shape;
}

/// A shape of a basis, its weights, and the weights of a motion.
struct moving_shape {
  gonio::shape::shape_basis basis = synthetic_basis(synthetic_shapes(8, 6, 3, 6));
  Eigen::VectorXd weights = basis.weights_of(4).col(0).cast<double>();
  point_columns shape = gonio::shape::shape_of(basis, weights);

  [[nodiscard]] Eigen::VectorXd with(const Eigen::Vector3d& turn, const Eigen::Vector3d& shift, double freedom) const {
    Eigen::VectorXd all(weights.size() + 6);
    all << weights, turn / freedom, shift / freedom;
    return all;
  }
};

}  // namespace

TEST_CASE("a shape with motion: the last six functions turn and shift the shape") {
  const moving_shape made;
  const double freedom = 100.0;
  const shape_with_motion functions(made.basis, made.shape, freedom);
  REQUIRE(functions.size() == made.basis.size() + 6);
  const Eigen::Vector3d centroid = made.shape.rowwise().mean(), turn(0.01, -0.02, 0.03), shift(1.0, 2.0, -3.0);
  point_columns expected = made.shape.colwise() + shift;
  for (Eigen::Index v = 0; v < expected.cols(); ++v) expected.col(v) += turn.cross(made.shape.col(v) - centroid);
  CHECK((combined(functions, made.with(turn, shift, freedom)) - expected).cwiseAbs().maxCoeff() < 1e-4);
  CHECK_THROWS_WITH_AS((void)shape_with_motion(made.basis, made.shape.leftCols(3)),
                       "a shape of 3 vertices does not match a basis of 8", gonio::error);
}

TEST_CASE("a shape with motion: weights are split into the shape's weights and the motion") {
  const moving_shape made;
  const double freedom = 100.0;
  const shape_with_motion functions(made.basis, made.shape, freedom);
  const Eigen::Vector3d turn(1e-4, -2e-4, 3e-4), shift(0.1, 0.2, -0.3);
  const Eigen::VectorXd weights = made.with(turn, shift, freedom);
  const auto [shape, motion] = functions.split(weights);
  CHECK(shape == made.weights);
  CHECK(std::abs(motion.rotation.determinant() - 1.0) < 1e-12);
  // For small rotations, the motion moves the shape as the functions do.
  CHECK((motion(made.shape) - combined(functions, weights)).cwiseAbs().maxCoeff() < 1e-5);
  const auto still = functions.split(made.with(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), freedom)).motion;
  CHECK((still(made.shape) - made.shape).cwiseAbs().maxCoeff() < 1e-12);
}
