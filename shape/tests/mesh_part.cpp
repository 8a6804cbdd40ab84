#include "synthetic_surfaces.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/mesh_part.hpp>
#include <gonio/shape/mesh_topology.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <iostream>  // rapidcheck.h does not include what it uses

TEST_CASE("a part has the marked triangles, each vertex once") {
  const gonio::shape::triangle_mesh mesh = flat_grid(3, 4);
  std::vector<bool> marked(12, true);
  CHECK(gonio::shape::part_of(mesh, marked).vertices.cols() == 12);
  CHECK(gonio::shape::part_of(mesh, marked).triangles.cols() == 12);
  marked[0] = false;  // a corner of two triangles
  const gonio::shape::triangle_mesh part = gonio::shape::part_of(mesh, marked);
  CHECK(part.triangles.cols() == 10);
  CHECK(part.vertices.cols() == 11);
  const gonio::shape::point_columns areas = gonio::shape::area_normals(part);
  for (Eigen::Index t = 0; t < areas.cols(); ++t) CHECK(areas(2, t) == doctest::Approx(1.0));
}

TEST_CASE("pieces that would touch in a single vertex are separated there") {
  const gonio::shape::triangle_mesh mesh = flat_grid(3, 3);
  // Vertices 2 and 6 are the corners off the diagonal. Without 1, 3, 5 and 7 only the middle would remain.
  std::vector<bool> marked(9, true);
  marked[2] = marked[6] = marked[1] = marked[5] = false;
  const gonio::shape::triangle_mesh one = gonio::shape::part_of(mesh, marked);
  CHECK_NOTHROW((void)gonio::shape::mesh_topology(one));
  marked.assign(9, true);
  marked[1] = marked[5] = marked[3] = marked[7] = false;
  CHECK_THROWS_WITH_AS((void)gonio::shape::part_of(mesh, marked),
                       "no triangle has three marked corners: no surface is left", gonio::error);
}

TEST_CASE("any part of a surface is a surface, with the triangles of the whole") {
  const gonio::shape::triangle_mesh sphere = sphere_mesh(2);
  const std::size_t vertices = sphere.vertices.cols();
  CHECK(rc::check([&] {
    const auto seed = *rc::gen::arbitrary<std::uint64_t>();
    std::mt19937_64 generator(seed);
    std::vector<bool> marked(vertices);
    for (std::size_t v = 0; v < vertices; ++v) marked[v] = synthetic_number(generator) < 0.7;
    std::vector<Eigen::Index> kept;
    for (Eigen::Index t = 0; t < sphere.triangles.cols(); ++t) {
      const Eigen::Vector3i corners = sphere.triangles.col(t);
      if (marked[corners[0]] && marked[corners[1]] && marked[corners[2]]) kept.push_back(t);
    }
    RC_PRE(!kept.empty());
    const gonio::shape::triangle_mesh part = gonio::shape::part_of(sphere, marked);
    (void)gonio::shape::mesh_topology(part);  // throws unless it is a surface
    RC_ASSERT(part.triangles.cols() == std::ssize(kept));
    for (Eigen::Index t = 0; t < part.triangles.cols(); ++t) RC_ASSERT(part.corners(t) == sphere.corners(kept[t]));
  }));
}

TEST_CASE("a wrong number of marks is refused") {
  CHECK_THROWS_WITH_AS((void)gonio::shape::part_of(tetrahedron(), {true}), "1 marks for the 4 vertices of a mesh",
                       gonio::error);
}
