#include "../archetypes.hpp"
#include <gonio/solve/solver.hpp>

#include <doctest/doctest.h>

static_assert(!gonio::solver<int>);

TEST_CASE("the archetype of a solver solves and certifies") {
  const gonio::row_matrix rows = gonio::row_matrix::Random(9, 4);
  const Eigen::MatrixXd truth = Eigen::MatrixXd::Random(4, 3);
  const auto found = archetype::ordinary_least_squares().solve({rows, rows * truth});
  CHECK(found.weights.isApprox(truth, 1e-10));
  CHECK(found.report.residual.maxCoeff() < 1e-12);
  CHECK(found.report.kkt_residual.maxCoeff() < 1e-12);
}
