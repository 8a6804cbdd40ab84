#include <gonio/core/random.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cstdint>

TEST_CASE("k of n: different, ascending, and all if there are not more") {
  CHECK(rc::check([] {
    const std::size_t n = *rc::gen::inRange(0, 100);
    const std::size_t count = *rc::gen::inRange(0, 100);
    const auto some = gonio::random_choice(n, count, 3);
    RC_ASSERT(some.size() == std::min(n, count));
    for (std::size_t i = 0; i < some.size(); ++i) {
      RC_ASSERT(some[i] < n);
      if (i > 0) RC_ASSERT(some[i - 1] < some[i]);
    }
  }));
}

TEST_CASE("k of n: each number is chosen as often as any other") {
  std::array<int, 6> chosen{};
  for (std::uint64_t seed = 0; seed < 6000; ++seed)
    for (const std::size_t i : gonio::random_choice(6, 2, seed)) ++chosen[i];
  // Each is expected 2000 times, with a standard deviation of 36.
  for (const int times : chosen) CHECK(std::abs(times - 2000) < 180);
}

TEST_CASE("uniform numbers: those of the generator, from 0 up to 1") {
  std::mt19937_64 generator(5), same(5);
  for (int i = 0; i < 1000; ++i) {
    const double number = gonio::uniform_number(generator);
    CHECK(number == static_cast<double>(same() / 2048) / 9007199254740992.0);
    CHECK((number >= 0.0 && number < 1.0));
  }
}
