#include <gonio/capture/mirror_sphere.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>

using gonio::capture::mirror_sphere;

TEST_CASE("mirror sphere: positions and light directions obey the law of reflection") {
  CHECK(rc::check("light, normal and camera lie in a plane, at equal angles", [] {
    const double distance = *rc::gen::inRange(105, 2000) / 100.0;
    const mirror_sphere sphere = *rc::gen::arbitrary<bool>() ? mirror_sphere(distance) : mirror_sphere();
    const double radius = *rc::gen::inRange(0, 1000) / 1000.0, azimuth = *rc::gen::inRange(0, 628) / 100.0;
    const Eigen::Vector2d position(radius * std::cos(azimuth), radius * std::sin(azimuth));
    const auto light = sphere.light_at(position);
    RC_ASSERT(light.has_value());
    RC_ASSERT(std::abs(light->norm() - 1.0) < 1e-12);

    // Intersect the ray through this position with the sphere, independently of the library.
    gonio::direction point, to_camera;
    if (std::isinf(sphere.distance())) {
      point = gonio::direction(position.x(), position.y(), std::sqrt(1.0 - radius * radius));
      to_camera = gonio::direction::UnitZ();
    } else {
      const gonio::direction camera(0.0, 0.0, distance);
      const double scale = 1.0 / std::sqrt(distance * distance - 1.0);
      const gonio::direction along = gonio::direction(position.x() * scale, position.y() * scale, -1.0).normalized();
      const double middle = -camera.dot(along), depth = distance * distance - middle * middle;
      point = camera + along * (middle - std::sqrt(std::max(0.0, 1.0 - depth)));
      to_camera = -along;
    }
    const gonio::direction reflected = 2.0 * point.dot(to_camera) * point - to_camera;
    RC_ASSERT((reflected - *light).norm() < 1e-6);
    const auto back = sphere.position_of(2.0 * *light);
    RC_ASSERT(back.has_value());
    RC_ASSERT((*back - position).norm() < 1e-6);
  }));
}

TEST_CASE("mirror sphere: visible and hidden light") {
  const mirror_sphere far, close(2.0);
  CHECK(far.largest_polar_angle() == doctest::Approx(std::numbers::pi));
  CHECK(far.position_of({0.0, 0.0, -1.0})->norm() == doctest::Approx(1.0));
  CHECK(close.largest_polar_angle() == doctest::Approx(std::numbers::pi * 5.0 / 6.0));
  CHECK_FALSE(close.position_of({0.0, 0.0, -1.0}).has_value());
  CHECK_FALSE(close.light_at({0.9, 0.9}).has_value());
  CHECK(far.position_of({0.0, 0.0, 3.0}) == Eigen::Vector2d(0.0, 0.0));
  // Eq. 2 and 3 of the note: light from the right is reflected where the normal is halfway between light and camera.
  CHECK((*far.position_of({1.0, 0.0, 0.0}) - Eigen::Vector2d(std::sqrt(0.5), 0.0)).norm() < 1e-12);
  CHECK((*far.position_of({0.0, 1.0, 0.0}) - Eigen::Vector2d(0.0, std::sqrt(0.5))).norm() < 1e-12);
  CHECK(mirror_sphere::spanning(gonio::radians(60.0)).distance() == doctest::Approx(2.0));
}

TEST_CASE("mirror sphere: its resolution is the derivative of the image position") {
  for (const mirror_sphere& sphere : {mirror_sphere(), mirror_sphere(4.0), mirror_sphere(1.5)}) {
    const auto radius = [&](double polar) {
      return sphere.position_of({std::sin(polar), 0.0, std::cos(polar)})->norm();
    };
    for (const double polar : {0.1, 1.0, 2.0, 0.98 * sphere.largest_polar_angle()}) {
      const double expected = (radius(polar + 1e-5) - radius(polar - 1e-5)) / 2e-5;
      CHECK(sphere.resolution(polar) == doctest::Approx(expected).epsilon(1e-4));
    }
    CHECK(sphere.resolution(sphere.largest_polar_angle()) < 1e-6);
  }
  CHECK(mirror_sphere().resolution(0.0) == doctest::Approx(0.5));
  CHECK(mirror_sphere(2.0).resolution(3.0) == 0.0);
}

TEST_CASE("mirror sphere: bad input is refused") {
  using doctest::Contains;
  CHECK_THROWS_WITH_AS(mirror_sphere(1.0), Contains("outside the mirror sphere"), gonio::error);
  CHECK_THROWS_WITH_AS(mirror_sphere(std::nan("")), Contains("outside the mirror sphere"), gonio::error);
  CHECK_THROWS_WITH_AS(mirror_sphere::spanning(4.0), Contains("between 0 and 180"), gonio::error);
}
