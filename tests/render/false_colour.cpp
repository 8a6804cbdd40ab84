#include <gonio/render/false_colour.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using gonio::rgb;
using gonio::render::category_colour;
using gonio::render::diverging_colour;

namespace {

bool is(const rgb& colour, double r, double g, double b) { return (colour - rgb(r, g, b)).abs().maxCoeff() < 1e-15; }

}  // namespace

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

namespace {

/// A linear colour as seen without green cones: Vienot, Brettel and Mollon 1999.
rgb without_green_cones(const rgb& colour) {
  const double yellow = 0.29275 * colour.x() + 0.70725 * colour.y();
  return {yellow, yellow, 0.02234 * (colour.y() - colour.x()) + colour.z()};
}

}  // namespace

TEST_CASE("from light to dark: lightness tells the order, with and without cones of green") {
  double lightness = 100.0, lightness_without = 100.0;
  for (int i = 0; i <= 20; ++i) {
    const rgb colour = gonio::render::sequential_colour(0.05 * i);
    CAPTURE(i);
    CHECK((colour >= 0.0).all());
    CHECK((colour <= 1.0).all());
    const double now = gonio::to_lab(colour).x(), now_without = gonio::to_lab(without_green_cones(colour)).x();
    CHECK(now < lightness - (i > 0 ? 2.5 : 0.0));
    CHECK(now_without < lightness_without - (i > 0 ? 2.5 : 0.0));
    lightness = now;
    lightness_without = now_without;
  }
  CHECK(gonio::encode_srgb(gonio::render::sequential_colour(-1.0).x()) == doctest::Approx(243.0 / 255.0).epsilon(1e-3));
  CHECK(gonio::encode_srgb(gonio::render::sequential_colour(7.0).z()) == doctest::Approx(99.0 / 255.0).epsilon(1e-3));
  CHECK((gonio::render::uncertainty_colour(0.02) == gonio::render::sequential_colour(0.0)).all());
  CHECK((gonio::render::uncertainty_colour(0.0) == gonio::render::sequential_colour(0.0)).all());
  const rgb middle = gonio::render::uncertainty_colour(std::sqrt(0.02));
  CHECK((middle - gonio::render::sequential_colour(0.5)).abs().maxCoeff() < 1e-12);
  CHECK((gonio::render::uncertainty_colour(3.0) == gonio::render::sequential_colour(1.0)).all());
}

TEST_CASE("a difference of colours is light where there is none, and dark from the paper's 20 on") {
  using gonio::render::difference_colour, gonio::render::sequential_colour;
  CHECK((difference_colour(0.0) == sequential_colour(0.0)).all());
  CHECK((difference_colour(10.0) == sequential_colour(0.5)).all());
  CHECK((difference_colour(20.0) == sequential_colour(1.0)).all());
  CHECK((difference_colour(std::numeric_limits<double>::infinity()) == sequential_colour(1.0)).all());
  CHECK((difference_colour(10.0, 40.0) == sequential_colour(0.25)).all());
}

TEST_CASE("categories: each two are told apart, and from black, with and without cones of green") {
  for (int i = 0; i < gonio::render::categories; ++i) {
    CAPTURE(i);
    CHECK(gonio::to_lab(category_colour(i)).x() > 40.0);
    for (int j = 0; j < i; ++j) {
      CAPTURE(j);
      CHECK(gonio::delta_e(category_colour(i), category_colour(j)) > 25.0);
      CHECK(gonio::delta_e(without_green_cones(category_colour(i)), without_green_cones(category_colour(j))) > 10.0);
    }
  }
}
