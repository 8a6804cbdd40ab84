#include "../archetypes.hpp"
#include <gonio/basis/basis.hpp>

#include <doctest/doctest.h>

static_assert(!gonio::basis<int>);

TEST_CASE("the archetype of a basis is read at a location") {
  const archetype::constant_basis functions{gonio::valid_cells(gonio::grid({5, 5, 5})), 0.25};
  const auto at = gonio::locate(functions.cells(), {0.3, 0.4, 0.5});
  CHECK(at.count == 8);
  CHECK(gonio::row_at(functions, at)[0] == doctest::Approx(1.0));
  CHECK(gonio::offset_at(functions, at) == doctest::Approx(0.25));
}

TEST_CASE("the archetype of a computed basis is read at the exact location, not between cells") {
  const archetype::theta_d_polynomial functions{gonio::valid_cells(gonio::grid({5, 5, 5})), 0.25};
  const auto at = gonio::locate(functions.cells(), {0.01, 0.02, 0.5});
  CHECK(gonio::row_at(functions, at) == Eigen::RowVector2d(1.0, 0.02));
  CHECK(gonio::offset_at(functions, at) == doctest::Approx(0.25));
}
