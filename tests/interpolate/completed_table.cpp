#include "../synthetic_materials.hpp"
#include <gonio/interpolate/completed_table.hpp>

#include <doctest/doctest.h>

TEST_CASE("a completed table is its table, with zeros for negative values") {
  auto table = synthetic_materials(small_cells(), 2).table(1);
  const float positive = table.values()[4];
  table.values()[3] = -0.5f;
  const gonio::completed_table fit(table);
  CHECK(fit.table().values()[3] == 0.0f);
  CHECK(fit.table().values()[4] == positive);
  CHECK(std::ranges::equal(fit.tabulate(small_cells()).values(), fit.table().values()));
  const gonio::valid_cells others(gonio::grid({5, 6, 7}));
  CHECK(fit.tabulate(others).at(11).x() == gonio::resample(fit.table(), others).at(11).x());
  const auto [wi, wo] = to_directions(small_cells().angles(1));
  CHECK(fit(wi, wo).x() == 0.0);
  CHECK((fit({0, 0, 1}, {1, 0, 0}) == 0.0).all());
}
