#include <gonio/core/error.hpp>
#include <gonio/shape/mesh_image.hpp>

#include <doctest/doctest.h>

namespace {

/// A square in z = 0 seen from above, and one behind it in another colour.
struct two_squares {
  gonio::shape::triangle_mesh mesh;
  std::vector<gonio::rgb> colours;

  two_squares() {
    mesh.vertices.resize(3, 8);
    mesh.vertices << -1, 1, 1, -1, -2, 2, 2, -2,  //
        -1, -1, 1, 1, -2, -2, 2, 2,               //
        0, 0, 0, 0, -1, -1, -1, -1;
    mesh.triangles.resize(3, 4);
    mesh.triangles << 0, 0, 4, 4, 1, 2, 5, 6, 2, 3, 6, 7;
    colours.assign(4, gonio::rgb(1, 0, 0));
    colours.resize(8, gonio::rgb(0, 0, 1));
  }
};

bool shows(const gonio::image& image, std::size_t row, std::size_t column, const gonio::rgb& colour) {
  return (gonio::pixel(image, row, column) - colour).abs().maxCoeff() < 1e-6;
}

}  // namespace

TEST_CASE("near triangles hide farther ones, from either side") {
  const two_squares scene;
  gonio::shape::mesh_view view;
  view.radius = 4.0;
  view.pixels = 80;  // ten per unit
  const gonio::image from_above = gonio::shape::image_of(scene.mesh, scene.colours, view);
  CHECK(shows(from_above, 40, 40, {1, 0, 0}));
  CHECK(shows(from_above, 31, 48, {1, 0, 0}));
  CHECK(shows(from_above, 28, 40, {0, 0, 1}));
  CHECK(shows(from_above, 21, 58, {0, 0, 1}));
  CHECK(shows(from_above, 18, 40, {1, 1, 1}));
  view.towards = gonio::rgb(0, 0, 1).matrix();
  const gonio::image from_below = gonio::shape::image_of(scene.mesh, scene.colours, view);
  CHECK(shows(from_below, 40, 40, gonio::rgb(0, 0, 0.3)));  // the inside
}

TEST_CASE("no pixel is left out between two triangles") {
  const two_squares scene;
  gonio::shape::mesh_view view;
  view.radius = 2.7;
  view.pixels = 173;
  const gonio::image image = gonio::shape::image_of(scene.mesh, scene.colours, view);
  std::size_t red = 0, blue = 0;
  for (std::size_t row = 0; row < 173; ++row)
    for (std::size_t column = 0; column < 173; ++column) {
      red += shows(image, row, column, {1, 0, 0});
      blue += shows(image, row, column, {0, 0, 1});
    }
  // 32.04 and 64.07 pixels to each side of the centre of the middle pixel.
  CHECK(red == 65 * 65);
  CHECK(blue == 129 * 129 - 65 * 65);
}

TEST_CASE("a view of a mesh holds it all") {
  const two_squares scene;
  const gonio::shape::mesh_view view = gonio::shape::mesh_view::of(scene.mesh, {0, 0, -1});
  CHECK(view.centre.z() == -0.5);
  CHECK((scene.mesh.vertices.colwise() - view.centre).colwise().norm().maxCoeff() < view.radius);
}

TEST_CASE("impossible images are refused") {
  const two_squares scene;
  CHECK_THROWS_WITH_AS(gonio::shape::image_of(scene.mesh, std::span(scene.colours).first(3), {}),
                       "an image of 8 vertices has 3 colours", gonio::error);
  gonio::shape::mesh_view view;
  view.towards = view.up;
  CHECK_THROWS_AS(gonio::shape::image_of(scene.mesh, scene.colours, view), gonio::error);
}
