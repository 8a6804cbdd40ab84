#include "synthetic_shapes.hpp"
#include "synthetic_surfaces.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/shape_model.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

namespace {

/// Returns randomly stretched and moved spheres.
std::vector<gonio::shape::point_columns> stretched_spheres(std::size_t count) {
  const gonio::shape::triangle_mesh sphere = sphere_mesh(1);
  std::mt19937_64 generator(1);
  std::vector<gonio::shape::point_columns> shapes;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d sizes, shift;
    for (double& size : sizes) size = 1.0 + 0.3 * synthetic_number(generator);
    for (double& along : shift) along = 10.0 * synthetic_number(generator);
    const Eigen::AngleAxisd turn(0.5 * synthetic_number(generator), Eigen::Vector3d::UnitZ());
    const gonio::shape::point_columns ellipsoid = sizes.asDiagonal() * sphere.vertices;
    shapes.push_back((turn.toRotationMatrix() * ellipsoid).colwise() + shift);
  }
  return shapes;
}

}  // namespace

TEST_CASE("a model has three directions of change for ellipsoids, wherever they were") {
  const auto shapes = stretched_spheres(12);
  const auto model = gonio::shape::learn_shape_model(shapes, synthetic_names(12), sphere_mesh(1).triangles);
  CHECK(model.shapes() == 12);
  CHECK(model.vertices() == shapes[0].cols());
  CHECK(model.truncated_to_variance(0.999).basis().size() <= 4);
  CHECK(model.truncated_to_variance(0.999).basis().size() >= 3);
  CHECK(model.mean().triangles == sphere_mesh(1).triangles);
  // A training shape is reproduced up to its pose.
  const gonio::shape::point_columns again = model.shape(model.basis().weights_of(5).col(0)).vertices;
  CHECK((gonio::shape::align(shapes[5], again)(shapes[5]) - again).cwiseAbs().maxCoeff() < 1e-5);
}

TEST_CASE("shapes that make no model are refused") {
  const auto shapes = stretched_spheres(3);
  const gonio::shape::triangle_columns triangles = sphere_mesh(1).triangles;
  CHECK_THROWS_WITH_AS(gonio::shape::learn_shape_model({shapes[0]}, synthetic_names(1), triangles),
                       "a shape model needs at least two different shapes, not 1 equal ones", gonio::error);
  CHECK_THROWS_WITH_AS(gonio::shape::learn_shape_model({shapes[0], shapes[0]}, synthetic_names(2), triangles),
                       "a shape model needs at least two different shapes, not 2 equal ones", gonio::error);
  CHECK_THROWS_AS(gonio::shape::learn_shape_model(shapes, synthetic_names(2), triangles), gonio::error);
  CHECK_THROWS_AS(gonio::shape::learn_shape_model(shapes, synthetic_names(3), tetrahedron().triangles.leftCols(0)),
                  gonio::error);
}
