#include <gonio/render/exposure.hpp>
#include <gonio/render/sphere.hpp>

#include <doctest/doctest.h>

#include <array>

using gonio::image;
using gonio::rgb;

namespace {

/// An image whose sphere has a fraction of bright pixels. Its surroundings are brighter than both.
image sphere_with(double share, const rgb& bright, const rgb& dark, int size = 100) {
  const std::size_t side = size;
  image picture = gonio::uniform_image(side, side, rgb::Constant(1000.0));
  const auto points = gonio::render::sphere_points(size);
  for (std::size_t i = 0; i < points.size(); ++i)
    gonio::set_pixel(picture, points[i].row, points[i].column,
                     static_cast<double>(i) < share * static_cast<double>(points.size()) ? bright : dark);
  return picture;
}

}  // namespace

TEST_CASE("a sphere is as bright as the brightest channel at its 99th percentile") {
  const rgb bright(2.0, 8.0, 1.0), dark(0.1, 0.2, 0.5);
  CHECK(gonio::render::brightness_of_sphere(sphere_with(0.009, bright, dark)) == doctest::Approx(0.5));
  CHECK(gonio::render::brightness_of_sphere(sphere_with(0.011, bright, dark)) == doctest::Approx(8.0));
  CHECK(gonio::render::brightness_of_sphere(sphere_with(0.4, bright, dark), 0.5) == doctest::Approx(0.5));
  CHECK_THROWS_AS((void)gonio::render::brightness_of_sphere(gonio::uniform_image(3, 4)), gonio::error);
}

TEST_CASE("spheres that are shown together are exposed alike, by the brightest") {
  std::array spheres{sphere_with(0.0, rgb::Zero(), rgb::Constant(0.25)), sphere_with(0.0, rgb::Zero(), rgb(0.5, 4, 1))};
  const double exposure = gonio::render::exposure_of_spheres(spheres);
  CHECK(exposure == doctest::Approx(0.25));
  for (image& sphere : spheres) gonio::render::expose(sphere, exposure);
  CHECK(gonio::pixel(spheres[0], 50, 50).x() == doctest::Approx(0.0625));
  CHECK(gonio::pixel(spheres[1], 50, 50).y() == doctest::Approx(1.0));
  const std::array black{sphere_with(0.0, rgb::Zero(), rgb::Zero())};
  CHECK(gonio::render::exposure_of_spheres(black) == 1.0);
}

TEST_CASE("an image is white at the 99th percentile of what is not black") {
  image picture = gonio::uniform_image(20, 20);
  CHECK(gonio::render::exposure_of(picture) == 1.0);
  for (std::size_t row = 0; row < 10; ++row)
    for (std::size_t column = 0; column < 20; ++column) gonio::set_pixel(picture, row, column, rgb(0.5, 4.0, 1.0));
  CHECK(gonio::render::exposure_of(picture) == doctest::Approx(0.25));
  gonio::set_pixel(picture, 3, 3, rgb(100.0, 0.0, 0.0));  // half a percent of the pixels
  CHECK(gonio::render::exposure_of(picture) == doctest::Approx(0.25));
}
