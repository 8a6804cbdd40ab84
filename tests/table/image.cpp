#include <gonio/table/image.hpp>

#include <doctest/doctest.h>

using gonio::image;
using gonio::rgb;

TEST_CASE("an image of one colour, and one changed pixel") {
  const rgb red(1.0, 0.0, 0.0), grey(0.25, 0.5, 0.75);
  image picture = gonio::uniform_image(2, 3, grey);
  REQUIRE(picture.shape(0) == 2);
  REQUIRE(picture.shape(1) == 3);
  REQUIRE(picture.shape(2) == 3);
  gonio::set_pixel(picture, 1, 2, red);
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      CHECK((gonio::pixel(picture, row, column) == (row == 1 && column == 2 ? red : grey)).all());
  // The same locations by xtensor's indices.
  CHECK(picture(1, 2, 0) == 1.0f);
  CHECK(picture(1, 2, 1) == 0.0f);
  CHECK(picture(0, 2, 1) == 0.5f);
  CHECK(picture(1, 1, 2) == 0.75f);
}
