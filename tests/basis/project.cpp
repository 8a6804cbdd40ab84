#include "../synthetic_materials.hpp"
#include <gonio/basis/project.hpp>

#include <doctest/doctest.h>

TEST_CASE("no weights come closer to a table in the mapped domain than its projection") {
  const gonio::valid_cells cells(gonio::grid({12, 6, 8}));
  const auto prior = learn(synthetic_materials(cells, 6), 4);
  const auto unseen = synthetic_materials(cells, 1, 99).table(0);
  const Eigen::MatrixXd best = gonio::project(prior, unseen);
  const auto misfit = [&](const Eigen::MatrixXd& weights) {
    double sum = 0;
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell)
      for (Eigen::Index c = 0; c < 3; ++c) {
        double y = prior.offset(cell) - prior.metric().forward(unseen.at(cell)[c], cell);
        for (std::size_t k = 0; k < 4; ++k) y += double{prior.row(cell)[k]} * weights(k, c);
        sum += y * y;
      }
    return sum;
  };
  const double least = misfit(best);
  for (Eigen::Index k = 0; k < 4; ++k)
    for (const double step : {-0.01, 0.01}) {
      Eigen::MatrixXd other = best;
      other(k, k % 3) += step;
      CHECK(misfit(other) > least);
    }
  CHECK(gonio::project(prior, unseen, {1}) == gonio::project(prior, unseen, {3}));
}

TEST_CASE("a table over other cells is refused") {
  const auto prior = learn(synthetic_materials(gonio::valid_cells(gonio::grid({12, 6, 8})), 3), 4);
  const gonio::brdf_table other(gonio::valid_cells(gonio::grid({12, 6, 9})));
  CHECK_THROWS_AS(static_cast<void>(gonio::project(prior, other)), gonio::error);
}
