#include "synthetic_surfaces.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/surface_distance.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using gonio::shape::surface_distance;

TEST_CASE("means of signed distances") {
  const surface_distance told = surface_distance::of(Eigen::Vector4d(1.0, -3.0, 2.0, 1.0));
  CHECK(told.signed_mean == 0.25);
  CHECK(told.absolute_mean == 1.75);
  CHECK(told.root_mean_square == doctest::Approx(std::sqrt(15.0 / 4.0)));
  CHECK(told.largest == 3.0);
}

TEST_CASE("a grown sphere is outside by its growth, a shrunk one inside") {
  const gonio::shape::surface_index surface(sphere_mesh(3, 10.0));
  const gonio::shape::point_columns vertices = surface.mesh().vertices;
  for (const double change : {0.5, -0.5}) {
    const surface_distance told = gonio::shape::distance_to(surface, (1.0 + 0.1 * change) * vertices);
    // Vertices of the shrunk sphere are nearer to the flat triangles than to the vertices.
    CHECK(told.signed_mean == doctest::Approx(change).epsilon(0.02));
    CHECK(told.absolute_mean == doctest::Approx(0.5).epsilon(0.02));
    CHECK(told.root_mean_square == doctest::Approx(0.5).epsilon(0.02));
    CHECK(told.largest <= 0.5 + 1e-12);
  }
}

TEST_CASE("some of the points only") {
  const gonio::shape::surface_index surface(flat_grid(3, 3));
  gonio::shape::point_columns points = surface.mesh().vertices;
  points(2, 4) = 0.3;
  points(2, 5) = -0.5;
  const std::vector<Eigen::Index> chosen{4, 5};
  const Eigen::VectorXd distances = gonio::shape::signed_distances(surface, points(Eigen::all, chosen));
  REQUIRE(distances.size() == 2);
  CHECK(distances[0] == doctest::Approx(0.3));
  CHECK(distances[1] == doctest::Approx(-0.5));
  const surface_distance told = gonio::shape::distance_to(surface, points(Eigen::all, chosen));
  CHECK(told.signed_mean == doctest::Approx(-0.1));
  CHECK(told.absolute_mean == doctest::Approx(0.4));
  CHECK(told.largest == doctest::Approx(0.5));
}

TEST_CASE("signed distances are the same for any number of threads") {
  std::mt19937_64 generator(7);
  const gonio::shape::surface_index surface(sphere_mesh(2));
  gonio::shape::point_columns points(3, 700);
  for (auto point : points.colwise()) point = synthetic_point(generator, 2.0);
  const Eigen::VectorXd one = gonio::shape::signed_distances(surface, points, {1});
  CHECK(one == gonio::shape::signed_distances(surface, points, {3}));
  for (Eigen::Index i = 0; i < 700; ++i) CHECK(one[i] == surface.signed_distance(points.col(i)));
}

TEST_CASE("distances of no points, or of points that are not finite, are refused") {
  const gonio::shape::surface_index surface(tetrahedron());
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::shape::distance_to(surface, gonio::shape::point_columns(3, 0))),
                       "the mean distance to a surface needs at least one point", gonio::error);
  gonio::shape::point_columns points = gonio::shape::point_columns::Zero(3, 2);
  points(1, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(static_cast<void>(gonio::shape::distance_to(surface, points)), gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(surface_distance::of(points.row(1))), "a distance to a surface is not finite",
                       gonio::error);
}
