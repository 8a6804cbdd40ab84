#include <gonio/table/surface_image.hpp>

#include <doctest/doctest.h>

TEST_CASE("an image of a surface sees nothing until it has a normal") {
  gonio::surface_image seen = gonio::surface_image::nothing(3, 4);
  CHECK(seen.normals.cols() == 12);
  CHECK(seen.pixel(2, 1) == 9);
  CHECK(!seen.sees(9));
  seen.normals(1, 9) = -1.0;
  CHECK(seen.sees(9));
  CHECK(!seen.sees(8));
}
