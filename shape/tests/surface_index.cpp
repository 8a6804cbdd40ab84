#include "synthetic_surfaces.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/surface_index.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <iostream>  // rapidcheck.h does not include what it uses
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

using gonio::shape::surface_index;
using gonio::shape::surface_point;

namespace {

/// Returns the closest point of a triangle by Ericson's seven regions, another method than the index uses.
Eigen::Vector3d closest_by_region(const Eigen::Matrix3d& corners, const Eigen::Vector3d& p) {
  const Eigen::Vector3d a = corners.col(0), b = corners.col(1), c = corners.col(2), ab = b - a, ac = c - a;
  const double d1 = ab.dot(p - a), d2 = ac.dot(p - a), d3 = ab.dot(p - b), d4 = ac.dot(p - b), d5 = ab.dot(p - c),
               d6 = ac.dot(p - c);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  if (d3 >= 0.0 && d4 <= d3) return b;
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
}

double least_distance(const gonio::shape::triangle_mesh& mesh, const Eigen::Vector3d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
    least = std::min(least, (closest_by_region(mesh.corners(t), point) - point).norm());
  return least;
}

/// Returns the smallest distance along a line of unit direction to a triangle, from its plane and its sides' planes.
std::optional<double> least_along(const gonio::shape::triangle_mesh& mesh, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& unit) {
  std::optional<double> least;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Matrix3d corners = mesh.corners(t);
    const Eigen::Vector3d first = corners.col(1) - corners.col(0), second = corners.col(2) - corners.col(0),
                          normal = first.cross(second);
    const double along = normal.dot(corners.col(0) - origin) / normal.dot(unit);
    const Eigen::Vector3d point = origin + along * unit;
    bool inside = std::isfinite(along);
    for (Eigen::Index side = 0; side < 3; ++side) {
      const Eigen::Vector3d edge = corners.col((side + 1) % 3) - corners.col(side);
      inside = inside && edge.cross(point - corners.col(side)).dot(normal) >= 0.0;
    }
    if (inside && (!least || std::abs(along) < *least)) least = std::abs(along);
  }
  return least;
}

/// Returns separate random triangles, including slivers.
gonio::shape::triangle_mesh triangle_soup(std::mt19937_64& generator, int triangles) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> corners;
  for (int t = 0; t < triangles; ++t) {
    const Eigen::Vector3d centre = synthetic_point(generator, 2.0);
    const double size = std::pow(10.0, -3.0 * synthetic_number(generator));
    for (int corner = 0; corner < 3; ++corner) vertices.emplace_back(centre + synthetic_point(generator, size));
    corners.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
  }
  return mesh_of(vertices, corners);
}

std::vector<gonio::shape::triangle_mesh> various_surfaces(std::mt19937_64& generator) {
  return {sphere_mesh(2),
          tube_mesh(6, 9),
          flat_grid(5, 4, 0.3, 0.4),
          triangle_soup(generator, 60),
          tetrahedron(),
          mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}})};
}

void check_consistent(const gonio::shape::triangle_mesh& mesh, const surface_point& found) {
  CHECK(found.barycentric.minCoeff() >= 0.0);
  CHECK(std::abs(found.barycentric.sum() - 1.0) < 1e-14);
  CHECK((mesh.corners(found.triangle) * found.barycentric - found.position).norm() < 1e-14);
}

}  // namespace

TEST_CASE("the closest point agrees with a search of all triangles") {
  std::mt19937_64 generator(1);
  for (const gonio::shape::triangle_mesh& mesh : various_surfaces(generator)) {
    const surface_index surface(mesh);
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d point = synthetic_point(generator, 3.0);
      const surface_point found = surface.closest(point);
      check_consistent(mesh, found);
      CHECK(std::abs(found.distance - least_distance(mesh, point)) < 1e-13);
      CHECK(std::abs(found.distance - (found.position - point).norm()) < 1e-14);
    }
  }
}

TEST_CASE("points of a surface are their own closest points") {
  CHECK(rc::check([] {
    const gonio::shape::triangle_mesh mesh = sphere_mesh(1);
    const Eigen::Index triangle = *rc::gen::inRange(0, 80);
    const double first = *rc::gen::inRange(0, 101) / 100.0;
    const double second = (1.0 - first) * *rc::gen::inRange(0, 101) / 100.0;
    const Eigen::Vector3d point = mesh.corners(triangle) * Eigen::Vector3d(1.0 - first - second, first, second);
    RC_ASSERT(surface_index(mesh).closest(point).distance < 1e-15);
  }));
}

TEST_CASE("a surface that is moved and grown has its closest points moved and grown") {
  CHECK(rc::check([](std::uint64_t seed) {
    std::mt19937_64 generator(seed);
    gonio::shape::triangle_mesh mesh = tube_mesh(4, 6);
    const Eigen::Vector3d point = synthetic_point(generator, 3.0), shift = synthetic_point(generator, 5.0);
    const Eigen::Vector3d axis = synthetic_point(generator, 1.0) + Eigen::Vector3d(0.0, 0.0, 2.0);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(synthetic_number(generator), axis.normalized()).toRotationMatrix();
    const double scale = 0.1 + 10.0 * synthetic_number(generator);
    const double before = surface_index(mesh).signed_distance(point);
    mesh.vertices = ((scale * turn * mesh.vertices).colwise() + shift).eval();
    const double after = surface_index(mesh).signed_distance(scale * turn * point + shift);
    RC_ASSERT(std::abs(after - scale * before) < 1e-12 * (1.0 + scale));
  }));
}

TEST_CASE("of equally near triangles, the one with the lowest number is returned") {
  const gonio::shape::triangle_mesh mesh = sphere_mesh(2);
  const surface_index surface(mesh);
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    const surface_point found = surface.closest(mesh.vertices.col(v));
    Eigen::Index lowest = 0;
    while ((mesh.triangles.col(lowest).array() != static_cast<int>(v)).all()) ++lowest;
    CHECK(found.triangle == lowest);
    CHECK(found.distance == 0.0);
  }
}

TEST_CASE("triangles without area are searched as well") {
  // Triangles that are a point, a segment with a vertex in its middle, and a segment with a repeated corner.
  const std::vector<Eigen::Vector3d> vertices{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {4, 0, 0},
                                              {3, 0, 0}, {5, 0, 0}, {5, 0, 0}, {5, 2, 0}};
  const surface_index surface(mesh_of(vertices, {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}));
  CHECK(surface.closest({-1, 2, 2}).distance == doctest::Approx(3.0));
  CHECK(surface.closest({2.5, 0, 1}).position == Eigen::Vector3d(2.5, 0, 0));
  CHECK(surface.closest({6, 1, 0}).position == Eigen::Vector3d(5, 1, 0));
  CHECK(surface.pseudonormal(surface.closest({6, 1, 0})) == Eigen::Vector3d::Zero());
  CHECK(surface.signed_distance({6, 1, 0}) == 1.0);
  CHECK_FALSE(surface.along({2.5, 0, 1}, {0, 0, 1}, 5.0));
}

TEST_CASE("a line's nearest intersection agrees with a search of all triangles") {
  std::mt19937_64 generator(2);
  int met = 0;
  for (const gonio::shape::triangle_mesh& mesh : various_surfaces(generator)) {
    const surface_index surface(mesh);
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d origin = synthetic_point(generator, 2.0);
      const Eigen::Vector3d direction = (synthetic_point(generator, 1.0) - origin).normalized();
      const auto expected = least_along(mesh, origin, direction);
      const auto found = surface.along(origin, 7.0 * direction, 100.0);
      REQUIRE(found.has_value() == expected.has_value());
      if (!found) continue;
      ++met;
      check_consistent(mesh, *found);
      CHECK(std::abs(found->distance - *expected) < 1e-10);
      const double along = (found->position - origin).dot(direction);
      CHECK(std::abs(std::abs(along) - found->distance) < 1e-8);
      CHECK((origin + along * direction - found->position).norm() < 1e-8);
      // The reach limits the distance.
      CHECK(surface.along(origin, direction, std::numeric_limits<double>::infinity())->triangle == found->triangle);
      CHECK(surface.along(origin, direction, 1.0001 * found->distance)->triangle == found->triangle);
      CHECK_FALSE(surface.along(origin, direction, 0.9999 * found->distance));
    }
  }
  CHECK(met > 500);
}

TEST_CASE("lines along an axis meet triangles perpendicular to it, in both directions") {
  const surface_index surface(flat_grid(4, 4));
  const Eigen::Vector3d origin(1.3, 1.4, 2.0);
  for (const double sign : {1.0, -1.0}) {
    const auto found = surface.along(origin, {0, 0, sign}, 2.0);
    REQUIRE(found);
    CHECK((found->position - Eigen::Vector3d(1.3, 1.4, 0.0)).norm() < 1e-15);
    CHECK(found->distance == 2.0);
  }
  CHECK_FALSE(surface.along(origin, {0, 0, 1}, 1.99));
  CHECK_FALSE(surface.along(origin, {1, 0, 0}, 100.0));
  CHECK_FALSE(surface.along({1, 1, 0}, {1, 0, 0}, 100.0));  // edge-on
  CHECK(surface.along({1.3, 1.4, 0}, {0, 0, 1}, 0.0)->distance == 0.0);
}

TEST_CASE("no line slips between triangles") {
  const gonio::shape::triangle_mesh mesh = sphere_mesh(2, 3.0);
  const surface_index surface(mesh);
  for (const auto& corners : mesh.triangles.colwise())
    for (Eigen::Index side = 0; side < 3; ++side)
      for (const double share : {0.0, 0.1, 1.0 / 3.0, 0.5}) {
        const Eigen::Vector3d point =
            (1.0 - share) * mesh.vertices.col(corners[side]) + share * mesh.vertices.col(corners[(side + 1) % 3]);
        const auto found = surface.along(0.1 * point, point, 10.0);
        REQUIRE(found);
        CHECK((found->position - point).norm() < 1e-8);
        CHECK_FALSE(found->on_border);
      }
}

TEST_CASE("a point beyond the border has its closest point on it, one before the surface has not") {
  const surface_index surface(flat_grid(3, 3));
  CHECK_FALSE(surface.closest({0.7, 0.9, 0.5}).on_border);
  CHECK_FALSE(surface.closest({1.0, 1.0, 0.5}).on_border);  // the inner vertex
  CHECK_FALSE(surface.closest({0.5, 0.5, 0.5}).on_border);  // an inner edge from a border vertex
  CHECK_FALSE(surface.closest({0.25, 1.0, -1.0}).on_border);
  CHECK(surface.closest({-0.1, 0.9, 0.5}).on_border);
  CHECK(surface.closest({2.5, 2.5, 0.0}).on_border);  // a corner
  CHECK(surface.closest({0.5, 0.0, 0.5}).on_border);  // just on the edge
  CHECK(surface.closest({0.0, 0.0, 0.5}).on_border);
  CHECK(surface.along({0.5, 0.0, 1.0}, {0, 0, 1}, 2.0)->on_border);
  CHECK_FALSE(surface.along({0.5, 0.01, 1.0}, {0, 0, 1}, 2.0)->on_border);
}

TEST_CASE("an inner edge between two border vertices is not a border") {
  const surface_index surface(mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}));
  CHECK_FALSE(surface.closest({0.5, 0.5, 1.0}).on_border);
  CHECK(surface.closest({0.0, 0.0, 1.0}).on_border);
}

TEST_CASE("a closed surface has no border to be closest to") {
  std::mt19937_64 generator(3);
  const surface_index surface(sphere_mesh(1));
  for (int i = 0; i < 300; ++i) CHECK_FALSE(surface.closest(synthetic_point(generator, 2.0)).on_border);
}

TEST_CASE("distances are positive outside of a closed surface and negative inside, near edges and vertices too") {
  std::mt19937_64 generator(4);
  for (const gonio::shape::triangle_mesh& mesh : {tetrahedron(), sphere_mesh(0), sphere_mesh(2)}) {
    const surface_index surface(mesh);
    const Eigen::Vector3d middle = mesh.vertices.rowwise().mean();
    const gonio::shape::point_columns normals = gonio::shape::unit_columns(gonio::shape::area_normals(mesh));
    for (int i = 0; i < 1000; ++i) {
      // A point near an edge, from its middle to its end.
      const Eigen::Index triangle = generator() % static_cast<std::uint64_t>(mesh.triangles.cols());
      const Eigen::Matrix3d corners = mesh.corners(triangle);
      const double share = std::min(1.0, 1.2 * synthetic_number(generator));
      const Eigen::Vector3d point =
          share * corners.col(0) + (1.0 - share) * corners.col(1) + synthetic_point(generator, i % 2 == 0 ? 1.0 : 1e-3);
      // The mesh is convex: a point is outside if it is outside some triangle's plane.
      double above = -std::numeric_limits<double>::infinity();
      for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
        above = std::max(above, normals.col(t).dot(point - mesh.corners(t).col(0)));
      if (std::abs(above) < 1e-12) continue;
      CHECK((surface.signed_distance(point) > 0.0) == (above > 0.0));
      CHECK(std::abs(surface.signed_distance(point)) == surface.closest(point).distance);
    }
    CHECK(surface.signed_distance(middle) < 0.0);
  }
}

TEST_CASE("the sign at a vertex is right where the area-weighted normal gives a wrong one") {
  // A spike with one triangle much larger than the other two.
  const std::vector<Eigen::Vector3d> vertices{{0, 0, 0}, {100, 0, -200}, {-50, 86.6, -200}, {-0.5, -0.866, -2}};
  const gonio::shape::triangle_mesh spike = mesh_of(vertices, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}});
  const surface_index surface(spike);
  const gonio::shape::point_columns means = gonio::shape::vertex_normals(spike);
  std::mt19937_64 generator(5);
  int outside = 0, wrong_by_mean = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d point = synthetic_point(generator, 1.0);
    const surface_point found = surface.closest(point);
    if (found.distance == 0.0 || found.position != spike.vertices.col(0)) continue;
    ++outside;  // the vertex is convex, so points closest to it are outside
    CHECK(surface.signed_distance(point) > 0.0);
    if (means.col(0).dot(point) < 0.0) ++wrong_by_mean;
  }
  CHECK(outside > 1000);
  CHECK(wrong_by_mean > 100);
}

TEST_CASE("pseudonormals: the triangle's normal, the mean of an edge's two, the angle-weighted mean at a vertex") {
  const surface_index surface(tetrahedron());
  const auto normal_near = [&](const Eigen::Vector3d& point) { return surface.pseudonormal(surface.closest(point)); };
  CHECK((normal_near({1, 1, 1}) - Eigen::Vector3d(1, 1, 1).normalized()).norm() < 1e-15);
  CHECK((normal_near({0.5, -1, -1}) - Eigen::Vector3d(0, -1, -1).normalized()).norm() < 1e-15);
  CHECK((normal_near({-1, -1, -1}) - Eigen::Vector3d(-1, -1, -1).normalized()).norm() < 1e-15);
  // Two angles of 45 degrees and one of 60 degrees.
  const Eigen::Vector3d at_tip = std::numbers::pi / 4.0 * Eigen::Vector3d(0, -1, -1) +
                                 std::numbers::pi / 3.0 * Eigen::Vector3d(1, 1, 1).normalized();
  CHECK((normal_near({5, 0, 0}) - at_tip.normalized()).norm() < 1e-14);
}

TEST_CASE("a query of many points gives the results of single queries, with any number of threads") {
  std::mt19937_64 generator(6);
  const surface_index surface(sphere_mesh(2));
  gonio::shape::point_columns points(3, 1000);
  for (auto point : points.colwise()) point = synthetic_point(generator, 2.0);
  const auto one = gonio::shape::closest_points(surface, points, {1}),
             three = gonio::shape::closest_points(surface, points, {3});
  REQUIRE(one.size() == 1000);
  REQUIRE(three.size() == 1000);
  for (std::size_t i = 0; i < 1000; ++i) {
    const surface_point single = surface.closest(points.col(i));
    CHECK((one[i].position == single.position && three[i].position == single.position));
    CHECK((one[i].triangle == single.triangle && three[i].triangle == single.triangle));
    CHECK((one[i].distance == single.distance && three[i].distance == single.distance));
  }
  CHECK(gonio::shape::closest_points(surface, gonio::shape::point_columns(3, 0)).empty());
}

TEST_CASE("a copy of an index outlives it and shares its mesh") {
  std::optional<surface_index> first(sphere_mesh(1));
  const surface_index second = *first;
  CHECK(&second.mesh() == &first->mesh());
  first.reset();
  CHECK(second.topology().vertices() == second.mesh().vertices.cols());
  CHECK(second.signed_distance({0, 0, 2}) > 0.9);
}

TEST_CASE("a mesh that is no surface is refused, and so are queries that are not finite") {
  CHECK_THROWS_AS(surface_index(gonio::shape::triangle_mesh{}), gonio::error);
  CHECK_THROWS_AS(surface_index(mesh_of({{0, 0, 0}}, {{0, 1, 2}})), gonio::error);
  const surface_index surface(tetrahedron());
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH_AS(static_cast<void>(surface.closest({0, nan, 0})),
                       "the point to find the closest point for is not finite", gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(surface.closest({1e200, 0, 0})), doctest::Contains("so far"), gonio::error);
  CHECK_THROWS_AS(static_cast<void>(surface.signed_distance({infinity, 0, 0})), gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(surface.along({nan, 0, 0}, {1, 0, 0}, 1.0)),
                       "the origin of a line is not finite", gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(surface.along({0, 0, 0}, {1, nan, 0}, 1.0)),
                       "the direction of a line is not finite", gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(surface.along({0, 0, 0}, {0, 0, 0}, 1.0)), doctest::Contains("is zero"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(surface.along({0, 0, 0}, {1, 0, 0}, -1.0)),
                       doctest::Contains("must be at least 0"), gonio::error);
  CHECK_THROWS_AS(static_cast<void>(surface.along({0, 0, 0}, {1, 0, 0}, nan)), gonio::error);
}
