#include "papers/noell2014/leave_one_out.hpp"

#include "../synthetic_materials.hpp"
#include <gonio/metric/log.hpp>
#include <gonio/solve/nnls.hpp>

#include <doctest/doctest.h>

TEST_CASE("leaving one out through the products is fitting its table by a basis without it") {
  const auto materials = synthetic_materials(small_cells(), 7);
  const gonio::measured basis{materials, gonio::log{}};
  const papers::leave_one_out_decomposition others{basis, gonio::nnls{}};
  for (const std::size_t material : std::vector<Eigen::Index>{0, 3, 6}) {
    const auto quick = others.reconstruct(material);
    const auto direct =
        gonio::decomposition{basis.without({materials.names[material]}), gonio::nnls{}}.fit(materials.table(material));
    CHECK(quick.weights().isApprox(direct.weights(), 1e-6));
    CHECK(quick.weights().row(material).isZero(0.0));
    CHECK(quick.report()->kkt_residual.maxCoeff() <= 1e-9);
    CHECK(quick.report()->residual.isApprox(direct.report()->residual, 1e-6));
    const auto one = quick.tabulate(small_cells()), other = direct.tabulate(small_cells());
    for (std::size_t i = 0; i < one.values().size(); ++i)
      REQUIRE(one.values()[i] == doctest::Approx(double{other.values()[i]}).epsilon(1e-3));
  }
}

TEST_CASE("what the basis leaves out stays out") {
  const auto materials = synthetic_materials(small_cells(), 5);
  const papers::leave_one_out_decomposition others{gonio::measured{materials, gonio::log{}}.without({"material-2"}),
                                                   gonio::nnls{}};
  CHECK(others.reconstruct(0).weights().row(2).isZero(0.0));
  CHECK(others.problem(2, 1).unknowns() == 4);
  CHECK(others.problem(0, 1).unknowns() == 3);
}

TEST_CASE("the only material has no others") {
  const papers::leave_one_out_decomposition alone{gonio::measured{synthetic_materials(small_cells(), 1), gonio::log{}},
                                                  gonio::nnls{}};
  CHECK_THROWS_AS(static_cast<void>(alone.reconstruct(0)), gonio::error);
}
