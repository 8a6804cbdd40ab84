#include <gonio/solve/compensated.hpp>

#include <doctest/doctest.h>

TEST_CASE("products that cancel keep the digits that rounding loses") {
  gonio::compensated_sum sum(1e16);
  sum.add(1.0);
  sum.add(-1e16);
  CHECK(sum.value() == 1.0);

  const double a = 1.0 + 0x1p-30;
  gonio::compensated_sum difference;
  difference.add_product(a, a);
  difference.add(-1.0);
  difference.add(-0x1p-29);
  CHECK(difference.value() == 0x1p-60);
}
