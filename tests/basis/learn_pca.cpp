#include "../dense_reference.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/basis/learn_pca.hpp>
#include <gonio/basis/project.hpp>

#include <Eigen/SVD>
#include <doctest/doctest.h>

using gonio::valid_cells;

TEST_CASE("components are those of a dense singular value decomposition") {
  const auto set = synthetic_materials(small_cells(), 6);
  const auto prior = learn(set, 18);
  Eigen::MatrixXd x(set.values.rows(), set.values.cols());
  for (Eigen::Index cell = 0; cell < x.rows(); ++cell)
    for (Eigen::Index j = 0; j < x.cols(); ++j) x(cell, j) = prior.metric().forward(set.values(cell, j), cell);
  const Eigen::VectorXd mean = x.rowwise().mean();
  x.colwise() -= mean;
  const auto svd = dense_reference::svd(x);

  CHECK(prior.size() < 18);  // centring removes one, and the channels of one lobe are linearly dependent
  for (std::size_t k = 0; k < 5; ++k) {
    CAPTURE(k);
    const Eigen::Index i = k;
    CHECK(prior.singular_values()[i] == doctest::Approx(svd.values[i]).epsilon(1e-5));
    // Up to sign, Q's column is V's times sigma.
    const Eigen::VectorXd q = prior.components().col(i).cast<double>();
    const Eigen::VectorXd expected = svd.u.col(i) * svd.values[i];
    CHECK(std::min((q - expected).norm(), (q + expected).norm()) < 1e-3 * expected.norm());
  }
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell)
    REQUIRE(prior.offset(cell) == doctest::Approx(mean[cell]).epsilon(1e-6));
}

TEST_CASE("the stored coefficients expand to the materials, and projection finds them") {
  const auto set = synthetic_materials(small_cells(), 6);
  const auto prior = learn(set, 18);
  for (std::size_t m = 0; m < 6; ++m) {
    const Eigen::MatrixXd weights = prior.weights_of(m);
    const gonio::brdf_table truth = set.table(m);
    // Errors in a component count in proportion to its singular value; components below 1e-5 of the first are dropped.
    const Eigen::MatrixXd moved = prior.singular_values().asDiagonal() * (gonio::project(prior, truth) - weights);
    CHECK(moved.cwiseAbs().maxCoeff() < 3e-5 * prior.singular_values()[0]);
    for (Eigen::Index cell = 0; cell < small_cells().size(); cell += 17)
      for (Eigen::Index c = 0; c < 3; ++c) {
        const auto row = prior.row(cell);
        double y = prior.offset(cell);
        for (Eigen::Index k = 0; k < prior.size(); ++k) y += double{row[k]} * weights(k, c);
        REQUIRE(prior.metric().inverse(y, cell) == doctest::Approx(truth.at(cell)[c]).epsilon(1e-3));
      }
  }
}

TEST_CASE("learning gives the same bytes for any number of threads") {
  const auto set = synthetic_materials(small_cells(), 5);
  const auto one = learn(set, 6, {1}), three = learn(set, 6, {3});
  CHECK(one.components() == three.components());
  CHECK(one.mean() == three.mean());
  CHECK(one.coefficients() == three.coefficients());
}

TEST_CASE("a thinned prior keeps its values where nodes coincide and stays close between them") {
  // Three cells of the fine grid make one coarse cell; the node of the middle one is that of the coarse cell.
  const valid_cells fine(gonio::grid({18, 27, 36})), coarse(gonio::grid({18, 9, 12}));
  const auto prior = learn(synthetic_materials(fine, 6), 6);
  const auto thinned = gonio::thin(prior, coarse);
  CHECK(thinned.size() == prior.size());
  CHECK(thinned.names() == prior.names());
  for (Eigen::Index cell = 0; cell < std::ssize(coarse); ++cell) {
    const auto index = coarse.grid().cell(coarse.linear(cell));
    const std::size_t same =
        fine.representative(fine.grid().linear({index.theta_h, 3 * index.theta_d + 1, 3 * index.phi_d + 1}));
    REQUIRE(thinned.row(cell)[0] == prior.row(same)[0]);
    REQUIRE(thinned.offset(cell) == prior.offset(same));
  }
  double sum = 0;
  for (Eigen::Index cell = 0; cell < std::ssize(fine); ++cell) {
    const auto row = gonio::row_at(thinned, gonio::locate(coarse, fine.angles(cell)));
    for (Eigen::Index k = 0; k < prior.size(); ++k) sum += std::pow(row[k] - double{prior.row(cell)[k]}, 2);
  }
  // The coarse steps are 10 degrees in theta_d and 15 in phi_d.
  CHECK(std::sqrt(sum) < 0.1 * prior.singular_values().norm());
}

TEST_CASE("unusable material sets are refused") {
  auto set = synthetic_materials(small_cells(), 2);
  CHECK_THROWS_AS(static_cast<void>(learn(set, 0)), gonio::error);
  auto same = set;
  same.values.setConstant(0.25f);
  CHECK_THROWS_WITH_AS(static_cast<void>(learn(same, 3)), doctest::Contains("do not differ"), gonio::error);
  const auto metric = gonio::log_relative::to_median_of(set);
  set.values(5, 2) = std::nanf("");
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::learn_pca(set, metric, 3)),
                       doctest::Contains("'material-0' is not finite at cell 5"), gonio::error);
  set.values(5, 2) = -std::numeric_limits<float>::infinity();  // the metric would count it as zero
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::learn_pca(set, metric, 3)),
                       doctest::Contains("'material-0' is not finite at cell 5"), gonio::error);
  CHECK_THROWS_AS(static_cast<void>(learn({small_cells(), {}, gonio::cell_matrix()}, 3)), gonio::error);
}
