#include <gonio/estimate/mapped_noise.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

TEST_CASE("quantiles of the normal distribution are symmetric, with its mean and nearly its variance") {
  CHECK(gonio::detail::normal_quantiles(1)[0] == doctest::Approx(0.0));
  const auto two = gonio::detail::normal_quantiles(2);
  CHECK(two[0] == doctest::Approx(-0.6744897502));
  CHECK(two[1] == doctest::Approx(0.6744897502));
  const auto many = gonio::detail::normal_quantiles(64);
  REQUIRE(many.size() == 64);
  for (std::size_t i = 0; i < 32; ++i) CHECK(many[i] == doctest::Approx(-many[63 - i]));
  const double squares = std::inner_product(many.begin(), many.end(), many.begin(), 0.0);
  CHECK(squares / 64.0 == doctest::Approx(1.0).epsilon(0.03));
}
