#include <gonio/io/half.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>

using gonio::io::from_half;
using gonio::io::to_half;

TEST_CASE("half floats: every one is its own nearest") {
  int other = 0;
  for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    const float value = from_half(half);
    if (std::isnan(value))
      other += std::isnan(from_half(to_half(value))) ? 0 : 1;
    else
      other += to_half(value) == half ? 0 : 1;
  }
  CHECK(other == 0);
}

TEST_CASE("half floats: between two the nearer is taken, in the middle the even one") {
  int other = 0;
  for (std::uint16_t half = 0; half < 0x7BFF; ++half) {
    const auto next = static_cast<std::uint16_t>(half + 1);
    const float low = from_half(half), high = from_half(next), middle = 0.5f * (low + high);
    other += to_half(middle) == (half % 2 == 0 ? half : next) ? 0 : 1;
    other += to_half(std::nextafter(middle, 0.0f)) == half ? 0 : 1;
    other += to_half(std::nextafter(middle, high)) == next ? 0 : 1;
    other += to_half(-middle) == (to_half(middle) | 0x8000) ? 0 : 1;
  }
  CHECK(other == 0);
}

TEST_CASE("half floats: what is beyond them is infinite, and what is tiny zero") {
  CHECK(from_half(to_half(65519.0f)) == gonio::io::largest_half);
  CHECK(std::isinf(from_half(to_half(65520.0f))));
  CHECK(std::isinf(from_half(to_half(std::numeric_limits<float>::max()))));
  CHECK(from_half(to_half(-std::numeric_limits<float>::infinity())) == -std::numeric_limits<float>::infinity());
  CHECK(to_half(0x1p-26f) == 0);
  CHECK(to_half(0x1.8p-25f) == 1);
  CHECK(to_half(-0.0f) == 0x8000);
}
