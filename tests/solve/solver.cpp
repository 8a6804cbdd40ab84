#include "../archetypes.hpp"
#include <gonio/solve/solver.hpp>

#include <doctest/doctest.h>

static_assert(!gonio::solver<int>);

TEST_CASE("the archetype of a solver solves and certifies") {
  const gonio::row_matrix rows = gonio::row_matrix::Random(9, 4);
  const Eigen::MatrixXd truth = Eigen::MatrixXd::Random(4, 3);
  const auto found = archetype::ordinary_least_squares().solve({rows, rows * truth});
  CHECK(found.weights.isApprox(truth, 1e-10));
  CHECK(found.residual.maxCoeff() < 1e-12);
  CHECK(found.certificate.maxCoeff() < 1e-12);
}

TEST_CASE("stationarity is relative to the moment of each column, absolute where that is zero") {
  Eigen::MatrixXd gradient(2, 2), moment(2, 2);
  gradient << 1, 0.5, -3, 0;
  moment << 0, 0, -6, 0;
  CHECK(gonio::stationarity(gradient, moment)[0] == 0.5);
  CHECK(gonio::stationarity(gradient, moment)[1] == 0.5);
}
