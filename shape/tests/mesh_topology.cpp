#include "synthetic_surfaces.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/mesh_topology.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>
#include <vector>

using gonio::shape::mesh_topology;

namespace {

std::vector<int> neighbours_in(const mesh_topology& topology, Eigen::Index vertex) {
  const auto neighbours = topology.neighbours(vertex);
  return {neighbours.begin(), neighbours.end()};
}

std::vector<Eigen::Index> border_of(const mesh_topology& topology) {
  std::vector<Eigen::Index> border;
  for (Eigen::Index v = 0; v < topology.vertices(); ++v)
    if (topology.on_border(v)) border.push_back(v);
  return border;
}

/// Returns closed fans of the given sizes around vertex 0, each closed below by another vertex: spindles.
gonio::shape::triangle_mesh spindles_touching(const std::vector<int>& sizes) {
  std::vector<Eigen::Vector3d> vertices{{0, 0, 0}};
  std::vector<Eigen::Vector3i> triangles;
  for (const int size : sizes) {
    const auto first = static_cast<int>(vertices.size()), bottom = first + size;
    for (int i = 0; i < size; ++i) {
      const int here = first + i, next = first + (i + 1) % size;
      vertices.emplace_back(std::cos(i), std::sin(i), bottom);
      triangles.emplace_back(0, here, next);
      triangles.emplace_back(bottom, next, here);
    }
    vertices.emplace_back(0, 0, 2 * bottom);
  }
  return mesh_of(vertices, triangles);
}

/// Returns the topology of these triangles; vertex positions do not matter.
mesh_topology topology_of(const std::vector<Eigen::Vector3i>& triangles, int vertices) {
  return mesh_topology(mesh_of({}, triangles).triangles, vertices);
}

}  // namespace

TEST_CASE("the neighbours of a grid's vertices are those that edges join, ascending") {
  const mesh_topology topology(flat_grid(3, 3));
  REQUIRE(topology.vertices() == 9);
  CHECK(neighbours_in(topology, 0) == std::vector{1, 3, 4});
  CHECK(neighbours_in(topology, 2) == std::vector{1, 5});
  CHECK(neighbours_in(topology, 4) == std::vector{0, 1, 3, 5, 7, 8});
  CHECK(border_of(topology) == std::vector<Eigen::Index>{0, 1, 2, 3, 5, 6, 7, 8});
}

TEST_CASE("neighbours are those of the triangles' sides, both ways, on any surface") {
  for (const gonio::shape::triangle_mesh& mesh : {sphere_mesh(2), tube_mesh(5, 7), flat_grid(4, 6), tetrahedron()}) {
    std::vector<std::set<int>> expected(mesh.vertices.cols());
    for (const auto& corners : mesh.triangles.colwise())
      for (const int from : corners)
        for (const int to : corners)
          if (from != to) expected[from].insert(to);
    const mesh_topology topology(mesh);
    for (std::size_t v = 0; v < expected.size(); ++v) {
      const std::vector<int> neighbours(expected[v].begin(), expected[v].end());
      CHECK(neighbours_in(topology, v) == neighbours);
    }
  }
}

TEST_CASE("a closed surface has no border, a tube two rings") {
  CHECK(border_of(mesh_topology(sphere_mesh(2))).empty());
  CHECK(border_of(mesh_topology(tube_mesh(4, 5))) == std::vector<Eigen::Index>{0, 1, 2, 3, 4, 15, 16, 17, 18, 19});
}

TEST_CASE("a vertex of no triangle is on the border and has no neighbours") {
  const mesh_topology topology = topology_of({{0, 2, 3}}, 5);
  CHECK(topology.on_border(1));
  CHECK(topology.neighbours(1).empty());
  CHECK(topology.neighbours(4).empty());
  CHECK(neighbours_in(topology, 3) == std::vector{0, 2});
}

TEST_CASE("a mesh without triangles is refused, and so is a vertex that is not finite") {
  CHECK_THROWS_WITH_AS(topology_of({}, 7), "a mesh of 7 vertices has no triangles", gonio::error);
  gonio::shape::triangle_mesh mesh = tetrahedron();
  mesh.vertices(1, 2) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS(mesh_topology{mesh}, "vertex 2 of a mesh is not finite", gonio::error);
  mesh.vertices(1, 2) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH_AS(mesh_topology{mesh}, "vertex 2 of a mesh is not finite", gonio::error);
}

TEST_CASE("triangles of vertices that do not exist or of one twice are refused") {
  CHECK_THROWS_WITH_AS(topology_of({{0, 1, 2}, {0, 2, 4}}, 4),
                       "triangle 1 names vertex 4, expected at least 0 and less than 4", gonio::error);
  CHECK_THROWS_WITH_AS(topology_of({{0, -1, 2}}, 4), "triangle 0 names vertex -1, expected at least 0 and less than 4",
                       gonio::error);
  for (const Eigen::Vector3i& twice : {Eigen::Vector3i(1, 1, 2), Eigen::Vector3i(1, 2, 2), Eigen::Vector3i(2, 1, 2)})
    CHECK_THROWS_WITH_AS(topology_of({{0, 1, 2}, twice}, 4), "triangle 1 of a mesh has one vertex twice", gonio::error);
}

TEST_CASE("an edge of three triangles is refused") {
  CHECK_THROWS_WITH_AS(topology_of({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, 5),
                       doctest::Contains("two triangles run from vertex 0 to vertex 1"), gonio::error);
}

TEST_CASE("a triangle that is turned over is refused") {
  gonio::shape::triangle_mesh mesh = sphere_mesh(1);
  std::swap(mesh.triangles(0, 11), mesh.triangles(1, 11));
  CHECK_THROWS_WITH_AS(mesh_topology{mesh}, doctest::Contains("in the same direction"), gonio::error);
}

TEST_CASE("open parts that touch in a vertex are refused, and neighbours in an open fan are not") {
  CHECK_THROWS_WITH_AS(topology_of({{0, 1, 2}, {0, 3, 4}}, 5),
                       "a mesh is not a surface: at vertex 0 parts of it touch in one point", gonio::error);
  CHECK_NOTHROW(topology_of({{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}, 5));
  CHECK_NOTHROW(topology_of({{0, 3, 4}, {0, 1, 2}, {0, 2, 3}}, 5));
}

TEST_CASE("closed fans that touch in a vertex are refused") {
  CHECK_NOTHROW(mesh_topology{spindles_touching({3})});
  const std::vector<std::vector<int>> touching{{3, 3}, {3, 4}, {4, 3}, {5, 5}, {3, 6}, {6, 3}, {4, 4, 4}};
  for (const auto& sizes : touching)
    CHECK_THROWS_WITH_AS(mesh_topology{spindles_touching(sizes)},
                         "a mesh is not a surface: at vertex 0 parts of it touch in one point", gonio::error);
}

TEST_CASE("an open and a closed fan that touch in a vertex are refused") {
  const gonio::shape::triangle_mesh closed = spindles_touching({4});
  std::vector<Eigen::Vector3i> triangles;
  for (const auto& corners : closed.triangles.colwise()) triangles.emplace_back(corners);
  triangles.emplace_back(0, 6, 7);
  CHECK_THROWS_WITH_AS(topology_of(triangles, 8), doctest::Contains("at vertex 0"), gonio::error);
  std::swap(triangles.front(), triangles.back());
  CHECK_THROWS_WITH_AS(topology_of(triangles, 8), doctest::Contains("at vertex 0"), gonio::error);
}
