#include <gonio/render/false_colour.hpp>

#include <doctest/doctest.h>

#include <limits>

using gonio::rgb;
using gonio::render::diverging_colour;
using gonio::render::false_colour;

namespace {

bool is(const rgb& colour, double r, double g, double b) { return (colour - rgb(r, g, b)).abs().maxCoeff() < 1e-15; }

}  // namespace

TEST_CASE("the paper's colours: 0 is blue, 10 green, 20 and more red") {
  CHECK(is(false_colour(0.0), 0.0, 0.0, 1.0));
  CHECK(is(false_colour(5.0), 0.0, 0.5, 0.5));
  CHECK(is(false_colour(10.0), 0.0, 1.0, 0.0));
  CHECK(is(false_colour(15.0), 0.5, 0.5, 0.0));
  CHECK(is(false_colour(20.0), 1.0, 0.0, 0.0));
  CHECK(is(false_colour(400.0), 1.0, 0.0, 0.0));
  CHECK(is(false_colour(-1.0), 0.0, 0.0, 1.0));
  CHECK(is(false_colour(std::numeric_limits<double>::infinity()), 1.0, 0.0, 0.0));
}

TEST_CASE("a colour gives its value back, on any range") {
  constexpr gonio::render::false_colour_range range{-2.0, 3.0};
  for (int i = 0; i <= 50; ++i) {
    const double value = -2.0 + 0.1 * i;
    CAPTURE(value);
    const rgb colour = false_colour(value, range);
    CHECK(colour.sum() == doctest::Approx(1.0).epsilon(1e-14));
    CHECK(-2.0 + 5.0 * (1.0 + colour.x() - colour.z()) / 2.0 == doctest::Approx(value).epsilon(1e-13).scale(1));
  }
}

TEST_CASE("a value with a sign: blue below zero, white at it, red above, and it gives its value back") {
  CHECK(is(diverging_colour(0.0, 2.0), 1.0, 1.0, 1.0));
  CHECK(is(diverging_colour(1.0, 2.0), 1.0, 0.5, 0.5));
  CHECK(is(diverging_colour(2.0, 2.0), 1.0, 0.0, 0.0));
  CHECK(is(diverging_colour(-0.5, 2.0), 0.75, 0.75, 1.0));
  CHECK(is(diverging_colour(-2.0, 2.0), 0.0, 0.0, 1.0));
  CHECK(is(diverging_colour(-std::numeric_limits<double>::infinity(), 2.0), 0.0, 0.0, 1.0));
  CHECK(is(diverging_colour(9.0, 2.0), 1.0, 0.0, 0.0));
  for (int i = -30; i <= 30; ++i) {
    const rgb colour = diverging_colour(0.1 * i, 3.0), opposite = diverging_colour(-0.1 * i, 3.0);
    CAPTURE(i);
    CHECK(3.0 * (colour.x() - colour.z()) == doctest::Approx(0.1 * i).epsilon(1e-13).scale(1));
    CHECK(is(opposite, colour.z(), colour.y(), colour.x()));
  }
}
