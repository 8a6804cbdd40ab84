#pragma once
/// Small surfaces for tests.

#include <gonio/shape/triangle_mesh.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

/// Returns a uniform number in [0, 1), the same with all standard libraries.
inline double synthetic_number(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11) * 0x1p-53; }

/// Returns a uniform point in a cube about zero.
inline Eigen::Vector3d synthetic_point(std::mt19937_64& generator, double half_size) {
  Eigen::Vector3d point;
  for (double& coordinate : point) coordinate = half_size * (2.0 * synthetic_number(generator) - 1.0);
  return point;
}

inline gonio::shape::triangle_mesh mesh_of(const std::vector<Eigen::Vector3d>& vertices,
                                           const std::vector<Eigen::Vector3i>& triangles) {
  gonio::shape::triangle_mesh mesh{gonio::shape::point_columns(3, std::ssize(vertices)),
                                   gonio::shape::triangle_columns(3, std::ssize(triangles))};
  for (std::size_t v = 0; v < vertices.size(); ++v) mesh.vertices.col(v) = vertices[v];
  for (std::size_t t = 0; t < triangles.size(); ++t) mesh.triangles.col(t) = triangles[t];
  return mesh;
}

/// Returns the corners (0, 0, 0), (1, 0, 0), (0, 1, 0) and (0, 0, 1), and the outward triangle opposite to each.
inline gonio::shape::triangle_mesh tetrahedron() {
  return mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}});
}

/// Returns a part of the plane z = 0, facing up. Vertex row * columns + column is at (width * column + shift * row,
/// height * row, 0), and each cell is cut from its first corner to the opposite one. With shift -width/2 and height
/// sqrt(3)/2 width, all triangles are equilateral.
inline gonio::shape::triangle_mesh flat_grid(int rows, int columns, double width = 1.0, double height = 1.0,
                                             double shift = 0.0) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      vertices.emplace_back(width * column + shift * row, height * row, 0.0);
      if (row == 0 || column == 0) continue;
      const int here = row * columns + column, below = here - columns;
      triangles.emplace_back(below - 1, below, here);
      triangles.emplace_back(below - 1, here, here - 1);
    }
  return mesh_of(vertices, triangles);
}

/// Returns an icosahedron whose triangles were divided into four `times` times and projected to a sphere about zero: 20
/// * 4^times triangles.
inline gonio::shape::triangle_mesh sphere_mesh(int times, double radius = 1.0) {
  const double golden = std::numbers::phi;
  std::vector<Eigen::Vector3d> vertices{{-1, golden, 0}, {1, golden, 0}, {-1, -golden, 0}, {1, -golden, 0},
                                        {0, -1, golden}, {0, 1, golden}, {0, -1, -golden}, {0, 1, -golden},
                                        {golden, 0, -1}, {golden, 0, 1}, {-golden, 0, -1}, {-golden, 0, 1}};
  std::vector<Eigen::Vector3i> triangles{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                         {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                         {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                         {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (; times > 0; --times) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [entry, made] = middles.try_emplace(std::minmax(a, b), static_cast<int>(vertices.size()));
      if (made) vertices.push_back(vertices[a] + vertices[b]);
      if (made) vertices.back() *= 0.5;
      return entry->second;
    };
    std::vector<Eigen::Vector3i> finer;
    for (const Eigen::Vector3i& t : triangles) {
      const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      for (const Eigen::Vector3i& part : {Eigen::Vector3i(t[0], a, c), Eigen::Vector3i(t[1], b, a),
                                          Eigen::Vector3i(t[2], c, b), Eigen::Vector3i(a, b, c)})
        finer.push_back(part);
    }
    triangles = std::move(finer);
  }
  gonio::shape::triangle_mesh mesh = mesh_of(vertices, triangles);
  mesh.vertices = radius * gonio::shape::unit_columns(mesh.vertices);
  return mesh;
}

/// Returns the open wall of a cylinder about the z axis, facing outwards: `rings` rings of `around` vertices, each
/// rotated by half a step relative to the one below, near-equilateral. Vertex i of a ring is ring * around + i.
inline gonio::shape::triangle_mesh tube_mesh(int rings, int around, double radius = 1.0) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  const double step = 2.0 * std::numbers::pi / around, rise = std::sqrt(0.75) * 2.0 * radius * std::sin(step / 2.0);
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < around; ++i) {
      const double angle = step * (i + 0.5 * ring);
      vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), rise * ring);
      if (ring == 0) continue;
      const int here = ring * around + i, next = ring * around + (i + 1) % around, below = here - around,
                below_next = next - around;
      triangles.emplace_back(below, below_next, here);
      triangles.emplace_back(below_next, next, here);
    }
  return mesh_of(vertices, triangles);
}
