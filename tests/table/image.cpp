#include <gonio/table/image.hpp>

#include <doctest/doctest.h>

using gonio::image;
using gonio::rgb;

TEST_CASE("an image of one colour, and one changed pixel") {
  const rgb red(1.0, 0.0, 0.0), grey(0.25, 0.5, 0.75);
  image pixels = gonio::uniform_image(2, 3, grey);
  REQUIRE(pixels.shape(0) == 2);
  REQUIRE(pixels.shape(1) == 3);
  REQUIRE(pixels.shape(2) == 3);
  gonio::set_pixel(pixels, 1, 2, red);
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      CHECK((gonio::pixel(pixels, row, column) == (row == 1 && column == 2 ? red : grey)).all());
  // The same locations by xtensor's indices.
  CHECK(pixels(1, 2, 0) == 1.0f);
  CHECK(pixels(1, 2, 1) == 0.0f);
  CHECK(pixels(0, 2, 1) == 0.5f);
  CHECK(pixels(1, 1, 2) == 0.75f);
}
