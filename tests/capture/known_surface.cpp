#include <gonio/capture/known_surface.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace {

gonio::lens_camera surface_camera() {
  return gonio::pinhole_camera::look_at({41, 61, 200.0, 200.0, 30.5, 20.5}, {0.0, 0.0, 10.0}, {0.0, 0.0, 0.0},
                                        {0.0, 1.0, 0.0});
}

}  // namespace

TEST_CASE("the visible points of a sphere lie on it, and their normals face the camera") {
  const gonio::capture::placed_sphere sphere{{0.2, -0.1, 0.5}, 0.8};
  const auto seen = gonio::capture::surface_of(sphere, surface_camera());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < seen.normals.cols(); ++i) {
    if (!seen.sees(i)) continue;
    ++count;
    const Eigen::Vector3d position = seen.positions.col(i), normal = seen.normals.col(i);
    REQUIRE(std::abs((position - sphere.centre).norm() - 0.8) < 1e-12);
    REQUIRE((position - sphere.centre - 0.8 * normal).norm() < 1e-12);
    REQUIRE(normal.dot(surface_camera().position() - position) > 0.0);
  }
  // A disc of radius 200 x tan(asin(0.8 / 9.5)) = 17 pixels, slightly larger off the axis.
  CHECK(count > 870);
  CHECK(count < 950);
  CHECK_THROWS_AS(gonio::capture::surface_of(gonio::capture::placed_sphere{{0, 0, 0}, -1.0}, surface_camera()),
                  gonio::error);
}

TEST_CASE("a plane is seen from its front alone") {
  const gonio::capture::placed_plane plane{{0.0, 0.0, 2.0}, {0.0, 0.0, 3.0}};
  const auto seen = gonio::capture::surface_of(plane, surface_camera());
  const Eigen::Index middle = seen.pixel(20, 30);
  CHECK((seen.positions.col(middle) - Eigen::Vector3d(0.0, 0.0, 2.0)).norm() < 1e-12);
  CHECK(seen.normals(2, middle) == 1.0);
  const auto behind = gonio::capture::surface_of(gonio::capture::placed_plane{{0, 0, 2}, {0, 0, -1}}, surface_camera());
  CHECK(!behind.sees(middle));
  CHECK_THROWS_AS(gonio::capture::surface_of(gonio::capture::placed_plane{{0, 0, 2}, {0, 0, 0}}, surface_camera()),
                  gonio::error);
}
