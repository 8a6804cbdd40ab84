#include "../synthetic_materials.hpp"
#include <gonio/core/error.hpp>
#include <gonio/table/material_rows.hpp>

#include <doctest/doctest.h>

TEST_CASE("rows of a set, and those of some of its materials") {
  const auto set = synthetic_materials(small_cells(), 5);
  const auto all = gonio::rows_of(set);
  gonio::cell_matrix read(7, 15);
  all.read({3, 10}, read);
  CHECK(read == set.values.middleRows(3, 7));
  const auto some = gonio::subset(all, {4, 1});
  CHECK(some.names == std::vector<std::string>{"material-4", "material-1"});
  CHECK(some.cells == set.cells);
  REQUIRE(some.columns() == 6);
  gonio::cell_matrix chosen(7, 6);
  some.read({3, 10}, chosen);
  CHECK(chosen.leftCols(3) == set.values.block(3, 12, 7, 3));
  CHECK(chosen.rightCols(3) == set.values.block(3, 3, 7, 3));
  CHECK_THROWS_WITH_AS((void)gonio::subset(all, {5}), doctest::Contains("number 5 among 5"), gonio::error);
  CHECK_THROWS_AS((void)gonio::subset(all, {-1}), gonio::error);
}
