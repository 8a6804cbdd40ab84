#include <gonio/core/half.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

TEST_CASE("half floats: known bits") {
  CHECK(gonio::to_half(1.0f) == 0x3c00);
  CHECK(gonio::to_half(-2.0f) == 0xc000);
  CHECK(gonio::to_half(65504.0f) == 0x7bff);
  CHECK(gonio::from_half(0x0001) == std::ldexp(1.0f, -24));
  CHECK(gonio::to_half(1.0f + std::ldexp(1.0f, -11)) == 0x3c00);  // a tie: rounds to even
  CHECK(std::isinf(gonio::from_half(gonio::to_half(65536.0f))));
  CHECK(std::isnan(gonio::from_half(gonio::to_half(std::numeric_limits<float>::quiet_NaN()))));
}
