#include "synthetic_surfaces.hpp"
#include <gonio/shape/correspondence.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

TEST_CASE("a shape finds itself on its own scan, wherever that lies") {
  const gonio::shape::triangle_mesh sphere = sphere_mesh(2);
  const Eigen::AngleAxisd turn(0.7, Eigen::Vector3d::UnitY());
  const gonio::shape::similarity_transform away{1.0, turn.toRotationMatrix(), {5.0, 2.0, -1.0}};
  const gonio::shape::posed_scan scan{gonio::shape::surface_index({away.inverse()(sphere.vertices), sphere.triangles}),
                                      away};
  const gonio::shape::vertex_observations found = gonio::shape::closest_correspondences(scan, sphere);
  REQUIRE(std::ssize(found.vertices) == sphere.vertices.cols());
  CHECK((found.positions - sphere.vertices).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((found.normals - gonio::shape::vertex_normals(sphere)).cwiseAbs().maxCoeff() < 0.05);
  const auto along = scan.along({0.0, 0.0, 3.0}, {0.0, 0.0, 1.0}, 2.5);
  REQUIRE(along);
  CHECK(along->position.z() == doctest::Approx(1.0).epsilon(0.05));
  CHECK_FALSE(scan.along({0.0, 0.0, 3.0}, {0.0, 0.0, 1.0}, 1.5));
}

TEST_CASE("points that are too far, on another side or on the border of the scan are no correspondences") {
  const gonio::shape::triangle_mesh sphere = sphere_mesh(2);
  gonio::shape::correspondence_options near;
  near.reach = 0.2;
  const gonio::shape::similarity_transform shift{1.0, Eigen::Matrix3d::Identity(), {0.0, 0.0, 0.5}};
  const gonio::shape::surface_index surface(sphere);
  const auto found = gonio::shape::closest_correspondences({surface, shift}, sphere, near);
  CHECK(!found.vertices.empty());
  CHECK(std::ssize(found.vertices) < sphere.vertices.cols());

  gonio::shape::triangle_mesh inside_out = sphere;
  inside_out.triangles.row(0).swap(inside_out.triangles.row(1));
  CHECK(gonio::shape::closest_correspondences({gonio::shape::surface_index(inside_out), {}}, sphere).vertices.empty());

  // For the upper half alone, the closest point to the lower half is on the border.
  gonio::shape::triangle_mesh half = sphere;
  Eigen::Index kept = 0;
  for (Eigen::Index t = 0; t < sphere.triangles.cols(); ++t)
    if (sphere.corners(t).row(2).minCoeff() > 0.1) half.triangles.col(kept++) = sphere.triangles.col(t);
  half.triangles.conservativeResize(3, kept);
  gonio::shape::correspondence_options wide;
  wide.normal_agreement = -1.0;
  const auto upper = gonio::shape::closest_correspondences({gonio::shape::surface_index(half), {}}, sphere, wide);
  CHECK(!upper.vertices.empty());
  for (const Eigen::Index vertex : upper.vertices) CHECK(sphere.vertices(2, vertex) > 0.1);
}
