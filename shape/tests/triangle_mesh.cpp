#include "synthetic_surfaces.hpp"
#include <gonio/shape/triangle_mesh.hpp>

#include <doctest/doctest.h>

#include <numbers>

TEST_CASE("a triangle's corners are its vertices in its order") {
  const gonio::shape::triangle_mesh mesh = tetrahedron();
  Eigen::Matrix3d expected;
  expected << 0, 0, 0, 0, 0, 1, 0, 1, 0;  // (0,0,0), (0,0,1), (0,1,0)
  CHECK(mesh.corners(1) == expected);
}

TEST_CASE("the normals of triangles are outward and as long as twice the area") {
  const gonio::shape::point_columns normals = gonio::shape::area_normals(tetrahedron());
  REQUIRE(normals.cols() == 4);
  CHECK(normals.col(0) == Eigen::Vector3d(1, 1, 1));
  CHECK(normals.col(1) == Eigen::Vector3d(-1, 0, 0));
  CHECK(normals.col(2) == Eigen::Vector3d(0, -1, 0));
  CHECK(normals.col(3) == Eigen::Vector3d(0, 0, -1));
}

TEST_CASE("a closed surface's normals by area sum to zero, and to its whole area by length") {
  const gonio::shape::point_columns normals = gonio::shape::area_normals(sphere_mesh(4, 3.0));
  CHECK(normals.rowwise().sum().norm() < 1e-11);
  CHECK(0.5 * normals.colwise().norm().sum() == doctest::Approx(4.0 * std::numbers::pi * 9.0).epsilon(5e-3));
}

TEST_CASE("the normals at vertices are the triangles' mean by area") {
  const gonio::shape::point_columns normals = gonio::shape::vertex_normals(tetrahedron());
  REQUIRE(normals.cols() == 4);
  CHECK((normals.col(0) - Eigen::Vector3d(-1, -1, -1).normalized()).norm() < 1e-15);
  CHECK((normals.col(1) - Eigen::Vector3d(1, 0, 0)).norm() < 1e-15);
}

TEST_CASE("the normals at the vertices of a sphere are radial") {
  const gonio::shape::triangle_mesh mesh = sphere_mesh(3, 2.0);
  const gonio::shape::point_columns radial = gonio::shape::unit_columns(mesh.vertices);
  CHECK((gonio::shape::vertex_normals(mesh) - radial).colwise().norm().maxCoeff() < 0.02);
}

TEST_CASE("a vertex of no triangle, or of triangles without area, has no normal") {
  const gonio::shape::triangle_mesh mesh =
      mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}, {{0, 1, 2}, {4, 5, 6}});
  const gonio::shape::point_columns normals = gonio::shape::vertex_normals(mesh);
  CHECK(normals.col(0) == Eigen::Vector3d(0, 0, 1));
  for (const Eigen::Index v : {3, 4, 5, 6}) CHECK(normals.col(v) == Eigen::Vector3d::Zero());
}

TEST_CASE("columns are made 1 long, and zero stays zero") {
  gonio::shape::point_columns vectors(3, 2);
  vectors << 3, 0, 0, 0, -4, 0;
  const gonio::shape::point_columns unit = gonio::shape::unit_columns(vectors);
  CHECK((unit.col(0) - Eigen::Vector3d(0.6, 0, -0.8)).norm() < 1e-15);
  CHECK(unit.col(1) == Eigen::Vector3d::Zero());
}
