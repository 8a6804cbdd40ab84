#include <gonio/core/error.hpp>
#include <gonio/interpolate/scattered_options.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

using gonio::half_difference;
using gonio::scattered_options;

TEST_CASE("a pair and its reciprocal are one location, and so are pairs turned about the normal") {
  const gonio::pair_embedding embed;
  const auto distance = [&](const half_difference& a, const half_difference& b) {
    const auto one = embed(a), other = embed(b);
    double square = 0.0;
    for (std::size_t i = 0; i < 4; ++i) square += std::pow(one[i] - other[i], 2);
    return std::sqrt(square);
  };
  CHECK(distance({0.3, 0.4, 0.2}, {0.3, 0.4, 0.2 + std::numbers::pi}) < 1e-15);
  CHECK(distance({0.3, 0.4, 1e-9}, {0.3, 0.4, std::numbers::pi - 1e-9}) < 1e-9);
  CHECK(distance({0.3, 0.0, 0.2}, {0.3, 0.0, 1.5}) == 0.0);   // phi_d is undefined
  CHECK(distance({0.0, 0.4, 0.2}, {0.0, 0.4, 1.5}) == 0.0);   // rotated about the normal
  CHECK(distance({0.3, 0.4, 0.2}, {0.3, 0.4, -0.2}) > 1e-3);  // mirrored: another pair
  // Near the normal, distances are larger because of the square root.
  CHECK(distance({0.0, 0.4, 0.0}, {0.01, 0.4, 0.0}) > 5.0 * distance({0.5, 0.4, 0.0}, {0.51, 0.4, 0.0}));
}

TEST_CASE("options out of their range are refused by name") {
  gonio::require_usable(scattered_options{});
  const auto refuses = [](const scattered_options& options, const char* name) {
    CHECK_THROWS_WITH_AS(gonio::require_usable(options), doctest::Contains(name), gonio::error);
  };
  for (const Eigen::Index neighbours : {-1, 0, 65}) refuses({.neighbours = neighbours}, "neighbours");
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const double wrong : {0.0, -1.0, nan, infinite}) {
    refuses({.exponent = wrong}, "exponent");
    refuses({.embedding = {.theta_d_scale = wrong}}, "theta_d scale");
    refuses({.embedding = {.phi_d_scale = wrong}}, "phi_d scale");
  }
}
