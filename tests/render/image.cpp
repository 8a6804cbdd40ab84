#include <gonio/render/image.hpp>

#include <doctest/doctest.h>

#include <vector>

using gonio::image;
using gonio::pixel;
using gonio::rgb;

namespace {

const rgb red(1.0, 0.0, 0.0), green(0.0, 1.0, 0.0), grey(0.25, 0.5, 0.75);

bool is(const image& picture, std::size_t row, std::size_t column, const rgb& colour) {
  return (pixel(picture, row, column) == colour).all();
}

}  // namespace

TEST_CASE("images side by side have one margin between them and one around") {
  const std::vector images{gonio::uniform_image(2, 3, red), gonio::uniform_image(4, 1, green)};
  const image row = gonio::render::side_by_side(images, 2, grey);
  REQUIRE(row.shape(0) == 2 + 4 + 2);
  REQUIRE(row.shape(1) == 2 + 3 + 2 + 1 + 2);
  for (std::size_t r = 0; r < row.shape(0); ++r)
    for (std::size_t c = 0; c < row.shape(1); ++c) {
      CAPTURE(r);
      CAPTURE(c);
      const bool in_red = r >= 2 && r < 4 && c >= 2 && c < 5, in_green = r >= 2 && r < 6 && c == 7;
      CHECK(is(row, r, c, in_red ? red : in_green ? green : grey));
    }
}

TEST_CASE("stacked images are the same from top to bottom") {
  const std::vector images{gonio::uniform_image(2, 3, red), gonio::uniform_image(4, 1, green)};
  const image column = gonio::render::stacked(images, 1, grey);
  REQUIRE(column.shape(0) == 1 + 2 + 1 + 4 + 1);
  REQUIRE(column.shape(1) == 1 + 3 + 1);
  for (std::size_t r = 0; r < column.shape(0); ++r)
    for (std::size_t c = 0; c < column.shape(1); ++c) {
      CAPTURE(r);
      CAPTURE(c);
      const bool in_red = r >= 1 && r < 3 && c >= 1 && c < 4, in_green = r >= 4 && r < 8 && c == 1;
      CHECK(is(column, r, c, in_red ? red : in_green ? green : grey));
    }
}

TEST_CASE("no images make an empty one, and no margin none") {
  CHECK(gonio::render::side_by_side({}).size() == 0);
  const std::vector one{gonio::uniform_image(2, 2, red)};
  CHECK(gonio::render::side_by_side(one) == one.front());
  CHECK(gonio::render::stacked(one) == one.front());
}
