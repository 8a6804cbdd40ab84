#include <gonio/capture/known_surface.hpp>
#include <gonio/shape/mesh_surface.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

using gonio::shape::surface_of;
using gonio::shape::triangle_mesh;

namespace {

gonio::lens_camera distorting_camera() {
  return {gonio::pinhole_camera::look_at(gonio::camera_intrinsics::square(64, gonio::radians(12.0)), {0.0, 0.0, 12.0},
                                         {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}),
          {.k1 = -0.25, .k2 = 0.1, .p1 = 0.002, .p2 = -0.001}};
}

/// Returns a sphere made of rings of quads, each split into two triangles. Its poles, where many vertices coincide, lie
/// on the outline that the camera sees.
triangle_mesh meshed_sphere(const gonio::capture::placed_sphere& sphere, int rings) {
  const int around = 2 * rings;
  triangle_mesh mesh;
  mesh.vertices.resize(3, (rings + 1) * around);
  mesh.triangles.resize(3, 2 * rings * around);
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < around; ++j) {
      const gonio::direction at =
          gonio::spherical_direction(std::numbers::pi * i / rings, 2.0 * std::numbers::pi * j / around);
      mesh.vertices.col(i * around + j) = sphere.centre + sphere.radius * Eigen::Vector3d(at.z(), at.x(), at.y());
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const int a = i * around + j, b = i * around + (j + 1) % around;
      mesh.triangles.col(2 * a) = Eigen::Vector3i(a, a + around, b + around);
      mesh.triangles.col(2 * a + 1) = Eigen::Vector3i(a, b + around, b);
    }
  return mesh;
}

/// Returns a horizontal square at a height, facing up.
triangle_mesh square_at(double height) {
  triangle_mesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices << -1.0, 1.0, 1.0, -1.0, -1.0, -1.0, 1.0, 1.0, height, height, height, height;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 0, 1, 2, 2, 3;
  return mesh;
}

}  // namespace

TEST_CASE("a fine mesh of a sphere is seen as the sphere is, through a lens that distorts") {
  const gonio::capture::placed_sphere sphere{{0.05, -0.1, 0.2}, 1.0};
  const gonio::lens_camera camera = distorting_camera();
  const gonio::surface_image exact = gonio::capture::surface_of(sphere, camera),
                             meshed = surface_of(meshed_sphere(sphere, 60), camera);
  int both = 0, one = 0;
  for (Eigen::Index pixel = 0; pixel < exact.normals.cols(); ++pixel) {
    if (exact.sees(pixel) != meshed.sees(pixel)) ++one;
    if (!(exact.sees(pixel) && meshed.sees(pixel))) continue;
    ++both;
    // Near the outline, rays meet facets at grazing angles.
    const double facing = exact.normals(2, pixel);
    if (facing < 0.3) continue;
    REQUIRE((exact.normals.col(pixel) - meshed.normals.col(pixel)).norm() < 0.01);
    REQUIRE((exact.positions.col(pixel) - meshed.positions.col(pixel)).norm() < 0.01);
  }
  CHECK(both > 1500);
  CHECK(one < both / 40);  // at the outline
}

TEST_CASE("the nearest triangle is seen, and hides the surfaces behind it") {
  const gonio::lens_camera camera = distorting_camera();
  triangle_mesh two = square_at(0.0);
  const triangle_mesh nearer = square_at(1.0);
  two.vertices.conservativeResize(3, 8);
  two.vertices.rightCols(4) = 0.5 * nearer.vertices;  // half as large, at the height of 0.5
  two.triangles.conservativeResize(3, 4);
  two.triangles.rightCols(2) = (nearer.triangles.array() + 4).matrix();
  const auto seen = surface_of(two, camera);
  CHECK(seen.positions(2, seen.pixel(32, 32)) == doctest::Approx(0.5));
  CHECK(seen.positions(2, seen.pixel(32, 8)) == doctest::Approx(0.0));
  CHECK((seen.normals.col(seen.pixel(32, 32)) - Eigen::Vector3d::UnitZ()).norm() < 1e-12);
  CHECK_FALSE(seen.sees(seen.pixel(0, 0)));
  // Seen from its inside, the nearer square shows nothing but still hides the other.
  two.triangles.rightCols(2).row(1).swap(two.triangles.rightCols(2).row(2));
  const auto inside = surface_of(two, camera);
  CHECK_FALSE(inside.sees(inside.pixel(32, 32)));
  CHECK(inside.sees(inside.pixel(32, 8)));
}

TEST_CASE("meshes that cannot be seen are refused") {
  const gonio::lens_camera camera = distorting_camera();
  const auto refuses = [&](const triangle_mesh& mesh, const char* why) {
    CHECK_THROWS_WITH_AS(static_cast<void>(surface_of(mesh, camera)), doctest::Contains(why), gonio::error);
  };
  triangle_mesh mesh = square_at(0.0);
  mesh.triangles(1, 1) = 4;
  refuses(mesh, "a vertex that does not exist, expected less than 4");
  mesh.triangles(1, 1) = -1;
  refuses(mesh, "does not exist");
  mesh = square_at(std::numeric_limits<double>::infinity());
  refuses(mesh, "not finite");
  mesh.triangles.resize(3, 0);
  refuses(mesh, "without triangles");
}
