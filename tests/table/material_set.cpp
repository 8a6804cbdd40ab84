#include <gonio/table/material_set.hpp>

#include <doctest/doctest.h>

TEST_CASE("a material is found by name and its table is three adjacent columns") {
  const gonio::valid_cells cells(gonio::grid({3, 3, 4}));
  gonio::material_set set{cells, {"clay", "gold"}, gonio::cell_matrix(static_cast<Eigen::Index>(cells.size()), 6)};
  for (Eigen::Index i = 0; i < set.values.size(); ++i) set.values.data()[i] = static_cast<float>(i);
  CHECK(set.find("gold") == 1);
  CHECK_THROWS_WITH_AS(static_cast<void>(set.find("glod")), doctest::Contains("'glod'"), gonio::error);
  const auto gold = set.table(1);
  CHECK(gold.at(0).isApprox(gonio::rgb(3, 4, 5)));
  CHECK(gold.at(2).isApprox(gonio::rgb(15, 16, 17)));
}
