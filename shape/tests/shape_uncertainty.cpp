#include "dense_reference.hpp"
#include "synthetic_shapes.hpp"
#include <gonio/core/probability.hpp>
#include <gonio/shape/shape_uncertainty.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/solve/truncated_svd.hpp>

#include <Eigen/Cholesky>
#include <doctest/doctest.h>

namespace {

/// Returns the coordinate rows of every other vertex, starting from the first or the second.
std::vector<Eigen::Index> every_other(Eigen::Index first, Eigen::Index vertices) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index v = first; v < vertices; v += 2)
    for (Eigen::Index axis = 0; axis < 3; ++axis) rows.push_back(3 * v + axis);
  return rows;
}

}  // namespace

TEST_CASE("V{s1|s2} equals the block formula where S22 has an inverse") {
  const Eigen::Index vertices = 6;
  const auto shapes = synthetic_shapes(vertices, 60, 5, 1);
  const gonio::shape::shape_basis basis = synthetic_basis(shapes);
  REQUIRE(basis.size() == 18);
  const Eigen::MatrixXd q = basis.components().cast<double>();
  const Eigen::MatrixXd covariance = q * q.transpose() / 60.0;
  const auto known_rows = every_other(0, vertices), missing_rows = every_other(1, vertices);
  const Eigen::MatrixXd s11 = covariance(missing_rows, missing_rows), s12 = covariance(missing_rows, known_rows),
                        s22 = covariance(known_rows, known_rows);
  const Eigen::MatrixXd expected = s11 - s12 * dense_reference::inverse(s22) * s12.transpose();

  const auto known = gonio::shape::vertex_observations::marked(shapes[0], {true, false, true, false, true, false});
  const gonio::truncated_svd solver{1.0};
  const auto fit = gonio::shape::fit_shape(basis, solver, known);
  const gonio::shape::shape_uncertainty uncertainty(fit, known, solver);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Matrix3d block = expected.block<3, 3>(3 * i, 3 * i);
    CHECK((uncertainty.as_published(2 * i + 1) - block).norm() < 1e-3 * block.norm());
    const double wider = 60.0 / (60.0 - 1.0 - 9.0) * (1.0 + 1.0 / 60.0 + fit.weights().squaredNorm());
    CHECK((uncertainty.covariance(2 * i + 1) - wider * block).norm() < 1e-3 * block.norm());
  }
  CHECK(uncertainty.as_published(0).norm() < 1e-9);  // a known vertex is known
}

TEST_CASE("with Tikhonov, the uncertainty is the posterior of the weights") {
  const auto shapes = synthetic_shapes(8, 20, 5, 2);
  const gonio::shape::shape_basis basis = synthetic_basis(shapes);
  const auto known =
      gonio::shape::vertex_observations::marked(shapes[3], {true, false, true, false, true, false, true, false});
  const double eta = 0.5;
  const gonio::tikhonov solver{eta};
  const gonio::shape::shape_uncertainty uncertainty(gonio::shape::fit_shape(basis, solver, known), known, solver);
  const Eigen::MatrixXd q2 = basis.components()(every_other(0, 8), Eigen::all).cast<double>();
  const Eigen::Index k = basis.size();
  const Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(k, k) + q2.transpose() * q2 / eta;
  const Eigen::MatrixXd posterior = dense_reference::inverse(precision) / 20.0;
  for (Eigen::Index vertex = 0; vertex < 8; ++vertex) {
    const Eigen::MatrixXd rows = basis.components().middleRows(3 * vertex, 3).cast<double>();
    const Eigen::Matrix3d expected = rows * posterior * rows.transpose();
    CHECK((uncertainty.as_published(vertex) - expected).norm() < 1e-6 * expected.norm());
  }
}

TEST_CASE("the true vertex is in the predicted 95 % ellipsoid nineteen times of twenty, from few shapes, too") {
  const double chi_square = gonio::chi_square_quantile(0.95, 3.0);
  for (const Eigen::Index count : {Eigen::Index{30}, Eigen::Index{300}}) {
    std::size_t inside = 0, inside_as_published = 0, all = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Eigen::Index vertices = 30;
      const auto shapes = synthetic_shapes(vertices, count + 20, 12, seed);
      const gonio::shape::shape_basis basis = synthetic_basis({shapes.begin(), shapes.end() - 20});
      std::vector<bool> marks(30, true);
      for (std::size_t v = 10; v < 20; ++v) marks[v] = false;
      for (auto shape = shapes.end() - 20; shape != shapes.end(); ++shape) {
        const auto known = gonio::shape::vertex_observations::marked(*shape, marks);
        const gonio::truncated_svd solver{0.999};
        const auto fit = gonio::shape::fit_shape(basis, solver, known);
        const gonio::shape::shape_uncertainty uncertainty(fit, known, solver);
        for (Eigen::Index v = 10; v < 20; v += 3) {
          const Eigen::Vector3d off = fit.vertex(v) - shape->col(v);
          inside += off.dot(uncertainty.covariance(v).llt().solve(off)) <= uncertainty.squared_radius(0.95);
          inside_as_published += off.dot(uncertainty.as_published(v).llt().solve(off)) <= chi_square;
          ++all;
        }
      }
    }
    const double share = static_cast<double>(inside) / static_cast<double>(all);
    const double published = static_cast<double>(inside_as_published) / static_cast<double>(all);
    MESSAGE(count << " shapes: " << share << " inside, as published " << published);
    CHECK(share > 0.93);
    CHECK(share < 0.97);
    CHECK(published < share);
  }
}
