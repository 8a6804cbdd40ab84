#include "dense_reference.hpp"
#include "synthetic_shapes.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/fitted_shape.hpp>
#include <gonio/solve/least_squares.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/solve/truncated_svd.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <iostream>  // rapidcheck.h does not include what it uses
#include <limits>

namespace {

/// Returns E{s1|y2} by Eq. 5-7, from the covariance of the shapes and the largest eigenvalues of S22 that explain a
/// share: all vertices, including predictions for the known ones.
gonio::shape::point_columns by_block_covariance(const gonio::shape::shape_basis& basis,
                                                const gonio::shape::vertex_observations& known, double share) {
  const Eigen::MatrixXd q = basis.components().cast<double>();
  const Eigen::MatrixXd covariance = q * q.transpose() / static_cast<double>(basis.names().size());
  std::vector<Eigen::Index> rows;
  for (const Eigen::Index vertex : known.vertices)
    for (Eigen::Index axis = 0; axis < 3; ++axis) rows.push_back(3 * vertex + axis);
  const Eigen::MatrixXd s22 = covariance(rows, rows), s12 = covariance(Eigen::all, rows);
  const auto eigen = dense_reference::symmetric_eigen(s22);
  const Eigen::VectorXd lambda = eigen.values.reverse();
  const Eigen::MatrixXd p = eigen.vectors.rowwise().reverse();
  Eigen::Index k = 0;
  for (double sum = 0.0; sum < share * lambda.sum(); ++k) sum += lambda[k];
  const Eigen::VectorXd mean = gonio::shape::mean_shape(basis).reshaped();
  const Eigen::VectorXd off = Eigen::VectorXd(known.positions.reshaped()) - mean(rows);
  const Eigen::VectorXd projected = (p.leftCols(k).transpose() * off).cwiseQuotient(lambda.head(k));
  const Eigen::VectorXd shape = mean + s12 * (p.leftCols(k) * projected);
  return shape.reshaped(3, mean.size() / 3);
}

}  // namespace

TEST_CASE("a fit to known vertices is the conditional expectation of Eq. 7") {
  CHECK(rc::check("for any known vertices and any share", [] {
    const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000000);
    const auto vertices = *rc::gen::inRange<Eigen::Index>(3, 12);
    const auto shapes = *rc::gen::inRange<std::size_t>(4, 20);
    const double share = *rc::gen::element(0.3, 0.9, 0.99);
    const auto all = synthetic_shapes(vertices, shapes + 1, 6, seed);
    const gonio::shape::shape_basis basis = synthetic_basis({all.begin(), all.end() - 1});
    std::vector<bool> marks(vertices, false);
    for (std::size_t v = 0; v < marks.size(); v += 2) marks[v] = true;
    const auto known = gonio::shape::vertex_observations::marked(all.back(), marks);
    const auto fit = gonio::shape::fit_shape(basis, gonio::truncated_svd{share}, known);
    const gonio::shape::point_columns expected = by_block_covariance(basis, known, share);
    RC_ASSERT((fit.vertices() - expected).cwiseAbs().maxCoeff() < 1e-4);
    RC_ASSERT(fit.report().kkt_residual[0] < 1e-9);
    RC_ASSERT((fit.vertex(1) - fit.vertices().col(1)).norm() < 1e-5);
  }));
}

TEST_CASE("a shape of the family is completed, but not with few components") {
  const auto all = synthetic_shapes(30, 60, 4, 7);
  const gonio::shape::shape_basis basis = synthetic_basis({all.begin(), all.end() - 1});
  std::vector<bool> marks(30, true);
  for (std::size_t v = 10; v < 20; ++v) marks[v] = false;
  const auto known = gonio::shape::vertex_observations::marked(all.back(), marks);
  const auto off = [&](const auto& solver) {
    return (gonio::shape::fit_shape(basis, solver, known).vertices() - all.back()).middleCols(10, 10).norm();
  };
  const double spread = (gonio::shape::mean_shape(basis) - all.back()).middleCols(10, 10).norm();
  CHECK(off(gonio::truncated_svd{0.99}) < 0.05 * spread);
  CHECK(off(gonio::tikhonov{1e-2}) < 0.05 * spread);
  CHECK(off(gonio::truncated_svd{0.3}) > 0.2 * spread);
}

TEST_CASE("all vertices known is a projection on the family") {
  const auto all = synthetic_shapes(8, 12, 3, 8);
  const gonio::shape::shape_basis basis = synthetic_basis(all);
  const auto known = gonio::shape::vertex_observations::marked(all[4], std::vector<bool>(8, true));
  const auto fit = gonio::shape::fit_shape(basis, gonio::truncated_svd{1.0}, known);
  CHECK((fit.vertices() - all[4]).cwiseAbs().maxCoeff() < 1e-4);
}

TEST_CASE("with normals, an error along the surface counts little; a vertex of weight 0 does not count") {
  const auto all = synthetic_shapes(30, 60, 4, 11);
  const gonio::shape::shape_basis basis = synthetic_basis({all.begin(), all.end() - 1});
  const auto fit = [&](const gonio::shape::vertex_observations& known) {
    return gonio::shape::fit_shape(basis, gonio::tikhonov{1e-3}, known);
  };
  const auto exact = gonio::shape::vertex_observations::marked(all.back(), std::vector<bool>(30, true));
  const double best = (fit(exact).vertices() - all.back()).norm();
  gonio::shape::vertex_observations slid = exact;
  for (Eigen::Index i = 0; i < 30; ++i) slid.positions.col(i) += Eigen::Vector3d(0.0, 0.5, -0.5);
  const double in_full = (fit(slid).vertices() - all.back()).norm();
  slid.normals = Eigen::Vector3d::UnitX().replicate(1, 30);
  slid.tangential = 1e-6;
  CHECK((fit(slid).vertices() - all.back()).norm() < 0.5 * in_full);

  gonio::shape::vertex_observations wrong = exact;
  wrong.positions.col(3).array() += 100.0;
  CHECK((fit(wrong).vertices() - all.back()).norm() > 10.0 * best);
  wrong.weights = Eigen::VectorXd::Ones(30);
  wrong.weights[3] = 0.0;
  CHECK((fit(wrong).vertices() - all.back()).norm() < 2.0 * best);

  wrong.normals = Eigen::Vector3d(1.0, 1.0, 0.0).replicate(1, 30);
  CHECK_THROWS_WITH_AS((void)fit(wrong), "the normal at known vertex 0 does not have length 1", gonio::error);
}

TEST_CASE("known vertices that say nothing are refused") {
  const gonio::shape::shape_basis basis = synthetic_basis(synthetic_shapes(5, 6, 3, 9));
  const auto fit = [&](const gonio::shape::vertex_observations& known) {
    return gonio::shape::fit_shape(basis, gonio::truncated_svd{0.99}, known);
  };
  gonio::shape::vertex_observations known;
  CHECK_THROWS_WITH_AS((void)fit(known), "no vertex is known: there is nothing to predict a shape from", gonio::error);
  known.vertices = {1, 5};
  known.positions = gonio::shape::point_columns::Zero(3, 2);
  CHECK_THROWS_WITH_AS((void)fit(known), "vertex 5 is known, but the shapes have 5 vertices", gonio::error);
  known.vertices = {1, 2, 3};
  CHECK_THROWS_WITH_AS((void)fit(known), "3 known vertices have 2 positions, 0 normals and 0 weights", gonio::error);
  known.vertices = {1, 2};
  known.positions(0, 1) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH_AS((void)fit(known), "the position of known vertex 2 is not finite", gonio::error);
}
