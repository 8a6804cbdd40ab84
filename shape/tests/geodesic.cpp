#include "synthetic_surfaces.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/geodesic.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <iostream>  // rapidcheck.h does not include what it uses
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

using gonio::shape::geodesic_distances;
using gonio::shape::mesh_topology;
using gonio::shape::nearest_along_surface;

namespace {

const auto any_vertex = [](Eigen::Index) { return true; };

/// Returns shortest paths by relaxing all edges until nothing changes (Bellman and Ford).
Eigen::VectorXd relaxed_distances(const gonio::shape::triangle_mesh& mesh, Eigen::Index source) {
  Eigen::VectorXd distances = Eigen::VectorXd::Constant(mesh.vertices.cols(), std::numeric_limits<double>::infinity());
  distances[source] = 0.0;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& corners : mesh.triangles.colwise())
      for (const int from : corners)
        for (const int to : corners) {
          const double further = distances[from] + (mesh.vertices.col(from) - mesh.vertices.col(to)).norm();
          if (!(further < distances[to])) continue;
          distances[to] = further;
          changed = true;
        }
  }
  return distances;
}

}  // namespace

TEST_CASE("distances on a grid of squares cut in two are those of steps and diagonals") {
  const gonio::shape::triangle_mesh mesh = flat_grid(8, 9);
  const Eigen::Index source = 3 * 9 + 4;
  const Eigen::VectorXd distances = geodesic_distances(mesh, mesh_topology(mesh), source);
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 9; ++column) {
      const int up = row - 3, right = column - 4;
      // The diagonals go only up to the right.
      const int diagonals = up * right > 0 ? std::min(std::abs(up), std::abs(right)) : 0;
      const double expected = diagonals * std::sqrt(2.0) + std::abs(up) + std::abs(right) - 2 * diagonals;
      CHECK(std::abs(distances[row * 9 + column] - expected) < 1e-13);
    }
}

TEST_CASE("paths on equilateral triangles are longer than straight lines by 10% on average and at most by 15.5%") {
  const gonio::shape::triangle_mesh mesh = flat_grid(121, 121, 1.0, std::sqrt(0.75), -0.5);
  const Eigen::Index source = 60 * 121 + 60;
  const Eigen::VectorXd distances = geodesic_distances(mesh, mesh_topology(mesh), source);
  double largest = 0.0, sum = 0.0;
  int count = 0;
  for (Eigen::Index v = 0; v < distances.size(); ++v) {
    const double straight = (mesh.vertices.col(v) - mesh.vertices.col(source)).norm();
    if (straight < 10.0 || straight > 50.0) continue;
    CHECK(distances[v] > straight - 1e-12);
    largest = std::max(largest, distances[v] / straight);
    sum += distances[v] / straight;
    ++count;
  }
  CHECK(largest == doctest::Approx(2.0 / std::sqrt(3.0)).epsilon(1e-3));
  CHECK(sum / count == doctest::Approx(2.0 * std::sqrt(3.0) / std::numbers::pi).epsilon(1e-3));
}

TEST_CASE("distances are the shortest of all paths along edges, and the same both ways") {
  CHECK(rc::check([](std::uint64_t seed) {
    std::mt19937_64 generator(seed);
    gonio::shape::triangle_mesh mesh = tube_mesh(4, 5);
    for (auto vertex : mesh.vertices.colwise()) vertex += synthetic_point(generator, 0.7);
    const mesh_topology topology(mesh);
    const Eigen::Index source = generator() % 20, other = generator() % 20;
    const Eigen::VectorXd distances = geodesic_distances(mesh, topology, source);
    RC_ASSERT((distances - relaxed_distances(mesh, source)).cwiseAbs().maxCoeff() < 1e-14);
    RC_ASSERT(std::abs(distances[other] - geodesic_distances(mesh, topology, other)[source]) < 1e-14);
  }));
}

TEST_CASE("vertices without a path are infinitely far, and are no neighbours") {
  gonio::shape::triangle_mesh mesh =
      mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 0.1}}, {{0, 1, 2}, {3, 4, 5}});
  const mesh_topology topology(mesh);
  const Eigen::VectorXd distances = geodesic_distances(mesh, topology, 1);
  CHECK(distances[1] == 0.0);
  CHECK(distances[2] == doctest::Approx(std::sqrt(2.0)));
  for (const Eigen::Index v : {3, 4, 5, 6}) CHECK(distances[v] == std::numeric_limits<double>::infinity());
  CHECK(nearest_along_surface(mesh, topology, 1, any_vertex, 10) == std::vector<Eigen::Index>{1, 0, 2});
  CHECK(nearest_along_surface(mesh, topology, 6, any_vertex, 10) == std::vector<Eigen::Index>{6});
}

TEST_CASE("the nearest candidates are the first of all by distance and number") {
  CHECK(rc::check([](std::uint64_t seed) {
    std::mt19937_64 generator(seed);
    gonio::shape::triangle_mesh mesh = flat_grid(6, 7);  // many vertices at equal distance
    if (generator() % 2 == 0)
      for (auto vertex : mesh.vertices.colwise()) vertex += synthetic_point(generator, 0.3);
    const mesh_topology topology(mesh);
    std::vector<bool> candidates;
    for (int v = 0; v < 42; ++v) candidates.push_back(generator() % 3 != 0);
    const auto is_candidate = [&](Eigen::Index v) { return candidates[v]; };
    const Eigen::Index source = generator() % 42;
    const Eigen::VectorXd distances = geodesic_distances(mesh, topology, source);
    std::vector<std::pair<double, Eigen::Index>> all;
    for (Eigen::Index v = 0; v < 42; ++v)
      if (is_candidate(v)) all.emplace_back(distances[v], v);
    std::ranges::sort(all);
    const std::size_t count = generator() % 50;
    std::vector<Eigen::Index> expected;
    for (std::size_t i = 0; i < std::min(count, all.size()); ++i) expected.push_back(all[i].second);
    RC_ASSERT(nearest_along_surface(mesh, topology, source, is_candidate, count) == expected);
  }));
}

TEST_CASE("coincident vertices are taken by number") {
  // Vertex 3 is at the position of 0, so the edge between them has length 0.
  const gonio::shape::triangle_mesh mesh =
      mesh_of({{1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}}, {{2, 3, 1}, {1, 3, 0}});
  const mesh_topology topology(mesh);
  const auto some = [](Eigen::Index v) { return v == 0 || v == 3; };
  CHECK(nearest_along_surface(mesh, topology, 2, some, 1) == std::vector<Eigen::Index>{0});
  CHECK(nearest_along_surface(mesh, topology, 2, some, 2) == std::vector<Eigen::Index>{0, 3});
}

TEST_CASE("the walk ends early") {
  const gonio::shape::triangle_mesh mesh = flat_grid(50, 50);
  int asked = 0;
  const auto counted = [&](Eigen::Index) {
    ++asked;
    return true;
  };
  CHECK(nearest_along_surface(mesh, mesh_topology(mesh), 1225, counted, 10).size() == 10);
  CHECK(asked < 20);
  asked = 0;
  CHECK(nearest_along_surface(mesh, mesh_topology(mesh), 1225, counted, 0).empty());
  CHECK(asked == 0);
}

TEST_CASE("distances from no vertex or on another mesh are refused") {
  const gonio::shape::triangle_mesh mesh = tetrahedron();
  const mesh_topology topology(mesh);
  for (const Eigen::Index none : {-1, 4})
    CHECK_THROWS_WITH_AS(static_cast<void>(geodesic_distances(mesh, topology, none)),
                         doctest::Contains("to start from does not exist, expected less than 4"), gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(nearest_along_surface(flat_grid(2, 3), topology, 0, any_vertex, 1)),
                       "a mesh of 6 vertices cannot have a topology of 4", gonio::error);
  gonio::shape::triangle_mesh moved = mesh;
  moved.vertices(0, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS(static_cast<void>(geodesic_distances(moved, topology, 0)), doctest::Contains("not finite"),
                       gonio::error);
}
