#include "synthetic_surfaces.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/hole_filling.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>  // rapidcheck.h does not include what it uses
#include <limits>
#include <vector>

using gonio::shape::fill_smoothly;
using gonio::shape::mesh_topology;
using gonio::shape::smoothness;

namespace {

/// Marks all points except those for which `is_missing(position)` is true.
template <class Missing>
std::vector<bool> known_but(const gonio::shape::point_columns& points, const Missing& is_missing) {
  std::vector<bool> known;
  for (const auto& point : points.colwise()) known.push_back(!is_missing(Eigen::Vector3d(point)));
  return known;
}

/// Returns the mesh's positions with the unknown ones replaced by NaN and filled in.
gonio::shape::point_columns filled(const gonio::shape::triangle_mesh& mesh, const std::vector<bool>& known,
                                   smoothness kind = smoothness::thin_plate) {
  gonio::shape::point_columns points = mesh.vertices;
  for (std::size_t v = 0; v < known.size(); ++v)
    if (!known[v]) points.col(v).setConstant(std::numeric_limits<double>::quiet_NaN());
  return fill_smoothly(mesh_topology(mesh), points, known, kind);
}

double largest_change(const gonio::shape::point_columns& one, const gonio::shape::point_columns& other) {
  return (one - other).colwise().norm().maxCoeff();
}

/// Returns |L x|^2 with L as documented, for a mesh without border.
double bending(const gonio::shape::triangle_mesh& mesh, const gonio::shape::point_columns& points) {
  const mesh_topology topology(mesh);
  double sum = 0.0;
  for (Eigen::Index v = 0; v < topology.vertices(); ++v) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const int neighbour : topology.neighbours(v)) middle += points.col(neighbour);
    sum += (middle / static_cast<double>(topology.neighbours(v).size()) - points.col(v)).squaredNorm();
  }
  return sum;
}

}  // namespace

TEST_CASE("a hole in an even plane is filled with the plane") {
  gonio::shape::triangle_mesh mesh = flat_grid(15, 16, 1.0, std::sqrt(0.75), -0.5);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  mesh.vertices = ((turn * mesh.vertices).colwise() + Eigen::Vector3d(5, -3, 2)).eval();
  const Eigen::Vector3d middle = mesh.vertices.rowwise().mean();
  const auto known = known_but(mesh.vertices, [&](const auto& point) { return (point - middle).norm() < 4.0; });
  CHECK(std::ranges::count(known, false) > 40);
  CHECK(largest_change(filled(mesh, known), mesh.vertices) < 1e-11);
  CHECK(largest_change(filled(mesh, known, smoothness::membrane), mesh.vertices) < 1e-11);
}

TEST_CASE("a plane is continued to a straight border") {
  const gonio::shape::triangle_mesh mesh = flat_grid(12, 12);
  const auto known =
      known_but(mesh.vertices, [](const auto& point) { return point.y() > 7.5 && point.x() > 2.5 && point.x() < 8.5; });
  CHECK(largest_change(filled(mesh, known), mesh.vertices) < 1e-11);
}

TEST_CASE("a strip whose edges across join border to border is continued along its borders") {
  const gonio::shape::triangle_mesh mesh = flat_grid(2, 12);
  const auto known = known_but(mesh.vertices, [](const auto& point) { return point.x() > 3.5 && point.x() < 7.5; });
  CHECK(largest_change(filled(mesh, known), mesh.vertices) < 1e-11);
}

TEST_CASE("a thin plate continues the curvature of a cylinder, a membrane flattens it") {
  const gonio::shape::triangle_mesh mesh = tube_mesh(30, 40, 5.0);
  const Eigen::Vector3d side(5.0, 0.0, mesh.vertices.row(2).mean());
  const auto known = known_but(mesh.vertices, [&](const auto& point) { return (point - side).norm() < 3.0; });
  const double sagitta = 5.0 - std::sqrt(25.0 - 9.0);  // error of a plane across the hole: 1
  CHECK(largest_change(filled(mesh, known), mesh.vertices) < 0.06 * sagitta);
  CHECK(largest_change(filled(mesh, known, smoothness::membrane), mesh.vertices) > 0.4 * sagitta);
}

TEST_CASE("a thin plate closes a sphere nearly round") {
  const gonio::shape::triangle_mesh mesh = sphere_mesh(4, 10.0);
  const auto known = known_but(mesh.vertices, [](const auto& point) { return point.z() > 8.0; });
  const gonio::shape::point_columns plate = filled(mesh, known), film = filled(mesh, known, smoothness::membrane);
  // The missing cap is 2 high.
  CHECK((plate.colwise().norm().array() - 10.0).abs().maxCoeff() < 0.3);
  CHECK(film.colwise().norm().minCoeff() < 8.5);
}

TEST_CASE("an end of a tube is continued by its slope") {
  gonio::shape::triangle_mesh cone = tube_mesh(20, 30, 5.0);
  for (auto vertex : cone.vertices.colwise()) vertex.head<2>() *= 1.0 - 0.02 * vertex.z();
  const double end = cone.vertices.row(2).maxCoeff();
  const auto known = known_but(cone.vertices, [&](const auto& point) { return point.z() > end - 3.0; });
  CHECK(largest_change(filled(cone, known), cone.vertices) < 0.8);  // 3 are missing
  CHECK(largest_change(filled(cone, known, smoothness::membrane), cone.vertices) > 2.0);
}

TEST_CASE("no other filling bends less, and known vertices stay") {
  CHECK(rc::check([](std::uint64_t seed) {
    std::mt19937_64 generator(seed);
    gonio::shape::triangle_mesh mesh = sphere_mesh(1);
    for (auto vertex : mesh.vertices.colwise()) vertex += synthetic_point(generator, 0.3);
    std::vector<bool> known;
    for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) known.push_back(generator() % 3 != 0);
    known[5] = true;
    const gonio::shape::point_columns best = filled(mesh, known);
    gonio::shape::point_columns other = best;
    for (std::size_t v = 0; v < known.size(); ++v) {
      const Eigen::Index column = v;
      if (known[v]) RC_ASSERT(best.col(column) == mesh.vertices.col(column));
      if (!known[v]) other.col(column) += synthetic_point(generator, 1e-3);
    }
    RC_ASSERT(bending(mesh, best) <= bending(mesh, other));
  }));
}

TEST_CASE("each vertex of a membrane is in the middle of its neighbours") {
  const gonio::shape::triangle_mesh mesh = sphere_mesh(2);
  const auto known = known_but(mesh.vertices, [](const auto& point) { return point.z() > 0.3; });
  const gonio::shape::point_columns film = filled(mesh, known, smoothness::membrane);
  const mesh_topology topology(mesh);
  for (Eigen::Index v = 0; v < film.cols(); ++v) {
    if (known[v]) continue;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const int neighbour : topology.neighbours(v)) middle += film.col(neighbour);
    CHECK((middle / static_cast<double>(topology.neighbours(v).size()) - film.col(v)).norm() < 1e-13);
  }
}

TEST_CASE("where all is known nothing changes") {
  const gonio::shape::triangle_mesh mesh = tetrahedron();
  CHECK(filled(mesh, std::vector<bool>(4, true)) == mesh.vertices);
}

TEST_CASE("holes that cannot be filled are refused") {
  const gonio::shape::triangle_mesh mesh = tetrahedron();
  const mesh_topology topology(mesh);
  const std::vector<bool> known{true, false, true, true};
  CHECK_THROWS_WITH_AS(static_cast<void>(fill_smoothly(topology, mesh.vertices.leftCols(3), known)),
                       "a mesh of 4 vertices has 3 points and 4 marks of known vertices", gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(fill_smoothly(topology, mesh.vertices, {true, true})),
                       "a mesh of 4 vertices has 4 points and 2 marks of known vertices", gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(fill_smoothly(topology, mesh.vertices, std::vector<bool>(4, false))),
                       doctest::Contains("no vertex is known"), gonio::error);
  gonio::shape::point_columns broken = mesh.vertices;
  broken(0, 2) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS(static_cast<void>(fill_smoothly(topology, broken, known)),
                       "the position of known vertex 2 is not finite", gonio::error);
}

TEST_CASE("a part of the mesh without known vertices is refused, and a known one of no triangle is no help") {
  const gonio::shape::triangle_mesh mesh =
      mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {9, 9, 9}}, {{0, 1, 2}, {3, 4, 5}});
  for (const smoothness kind : {smoothness::membrane, smoothness::thin_plate})
    CHECK_THROWS_WITH_AS(static_cast<void>(filled(mesh, {true, true, false, false, false, false, true}, kind)),
                         "vertex 3 cannot be filled in: no known vertex is in its part of the mesh", gonio::error);
}

TEST_CASE("a thin plate that may still turn is refused") {
  for (int around = 8; around < 20; ++around) {
    const gonio::shape::triangle_mesh mesh = tube_mesh(9, around);
    const double middle = mesh.vertices.row(2).mean();
    const auto known = known_but(mesh.vertices, [&](const auto& point) { return std::abs(point.z() - middle) > 1e-9; });
    REQUIRE(std::ranges::count(known, true) == around);
    CHECK_THROWS_WITH_AS(static_cast<void>(filled(mesh, known)), "the known vertices do not determine the missing ones",
                         gonio::error);
    CHECK_NOTHROW(static_cast<void>(filled(mesh, known, smoothness::membrane)));
  }
}
