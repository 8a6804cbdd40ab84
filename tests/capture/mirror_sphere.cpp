#include <gonio/capture/mirror_sphere.hpp>
#include <gonio/render/environment_map.hpp>

#include <doctest/doctest.h>
#include <lab/mirror_sphere_lab.hpp>
#include <rapidcheck.h>

using gonio::capture::mirror_sphere;
using gonio::capture::unwrap;

namespace {

/// The mean over the pixels of a map, weighed by solid angle, of how far another is off relative to it, where light
/// comes from at most this angle from the camera.
double mean_relative_error(const gonio::render::environment_map& truth, const gonio::image& found,
                           double largest_angle) {
  double sum = 0.0, weights = 0.0;
  for (std::size_t row = 0; row < truth.rows(); ++row)
    for (std::size_t column = 0; column < truth.columns(); ++column) {
      if (std::acos(std::clamp(truth.towards(row, column).z(), -1.0, 1.0)) > largest_angle) continue;
      const gonio::rgb expected = gonio::pixel(truth.image(), row, column);
      sum += truth.solid_angle(row) * ((gonio::pixel(found, row, column) - expected).abs() / expected).mean();
      weights += truth.solid_angle(row);
    }
  return sum / weights;
}

}  // namespace

TEST_CASE("mirror sphere: what reflects where, by the law of reflection") {
  CHECK(rc::check("light, normal and camera lie in a plane, at equal angles", [] {
    const double distance = *rc::gen::inRange(105, 2000) / 100.0;
    const mirror_sphere sphere = *rc::gen::arbitrary<bool>() ? mirror_sphere(distance) : mirror_sphere();
    const double radius = *rc::gen::inRange(0, 1000) / 1000.0, azimuth = *rc::gen::inRange(0, 628) / 100.0;
    const Eigen::Vector2d place(radius * std::cos(azimuth), radius * std::sin(azimuth));
    const auto light = sphere.light_at(place);
    RC_ASSERT(light.has_value());
    RC_ASSERT(std::abs(light->norm() - 1.0) < 1e-12);

    // The ray through the place, met with the sphere here on its own.
    gonio::direction point, to_camera;
    if (std::isinf(sphere.distance())) {
      point = gonio::direction(place.x(), place.y(), std::sqrt(1.0 - radius * radius));
      to_camera = gonio::direction::UnitZ();
    } else {
      const gonio::direction camera(0.0, 0.0, distance);
      const double scale = 1.0 / std::sqrt(distance * distance - 1.0);
      const gonio::direction along = gonio::direction(place.x() * scale, place.y() * scale, -1.0).normalized();
      const double middle = -camera.dot(along), depth = distance * distance - middle * middle;
      point = camera + along * (middle - std::sqrt(std::max(0.0, 1.0 - depth)));
      to_camera = -along;
    }
    const gonio::direction reflected = 2.0 * point.dot(to_camera) * point - to_camera;
    RC_ASSERT((reflected - *light).norm() < 1e-6);
    const auto back = sphere.place_of(2.0 * *light);
    RC_ASSERT(back.has_value());
    RC_ASSERT((*back - place).norm() < 1e-6);
  }));
}

TEST_CASE("mirror sphere: what it shows and hides") {
  const mirror_sphere far, close(2.0);
  CHECK(far.largest_polar_angle() == doctest::Approx(std::numbers::pi));
  CHECK(far.place_of({0.0, 0.0, -1.0})->norm() == doctest::Approx(1.0));
  CHECK(close.largest_polar_angle() == doctest::Approx(std::numbers::pi * 5.0 / 6.0));
  CHECK_FALSE(close.place_of({0.0, 0.0, -1.0}).has_value());
  CHECK_FALSE(close.light_at({0.9, 0.9}).has_value());
  CHECK(far.place_of({0.0, 0.0, 3.0}) == Eigen::Vector2d(0.0, 0.0));
  // Eq. 2 and 3 of the note: light from the right is seen where the normal is half-way between.
  CHECK((*far.place_of({1.0, 0.0, 0.0}) - Eigen::Vector2d(std::sqrt(0.5), 0.0)).norm() < 1e-12);
  CHECK((*far.place_of({0.0, 1.0, 0.0}) - Eigen::Vector2d(0.0, std::sqrt(0.5))).norm() < 1e-12);
  CHECK(mirror_sphere::spanning(gonio::radians(60.0)).distance() == doctest::Approx(2.0));
}

TEST_CASE("mirror sphere: a map, its image in the sphere, and back") {
  const auto truth = gonio::render::environment_map::of(gonio::render::formula_environment{}, 64);
  for (const mirror_sphere& sphere : {mirror_sphere(), mirror_sphere(4.0), mirror_sphere(20.0)}) {
    const auto probe = lab::photograph(sphere, truth, 512);
    const auto map = unwrap(probe, sphere, {.rows = 64});
    const double visible = sphere.largest_polar_angle() - gonio::radians(10.0);
    CHECK(mean_relative_error(truth, map, visible) < 0.02);
    // The wrong sphere is noticed.
    CHECK(mean_relative_error(truth, unwrap(probe, mirror_sphere(2.0), {.rows = 64}), visible) > 0.02);
  }
  const mirror_sphere sphere(4.0);
  const auto probe = lab::photograph(sphere, truth, 256);
  CHECK(unwrap(probe, sphere, {.rows = 32}, gonio::thread_count{1}) ==
        unwrap(probe, sphere, {.rows = 32}, gonio::thread_count{3}));
  const gonio::image bright = unwrap(probe, sphere, {.rows = 32, .reflectance = 0.5});
  CHECK(bright(10, 10, 1) == doctest::Approx(2.0 * unwrap(probe, sphere, {.rows = 32})(10, 10, 1)));
}

TEST_CASE("mirror sphere: a map is as symmetric as the light") {
  const auto symmetric = [](const gonio::direction& from) {
    return gonio::rgb::Constant(2.0 + from.z() + from.x() * from.x() - 0.5 * from.y() * from.y());
  };
  const mirror_sphere sphere(4.0);
  for (const std::size_t rows : {8u, 64u}) {
    const auto map = unwrap(lab::photograph(sphere, symmetric, 128), sphere, {.rows = rows});
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t column = 0; column < 2 * rows; ++column) {
        const double here = map(row, column, 1);
        REQUIRE(map(row, 2 * rows - 1 - column, 1) == doctest::Approx(here).epsilon(1e-4));
        REQUIRE(map(rows - 1 - row, column, 1) == doctest::Approx(here).epsilon(1e-4));
      }
  }
}

TEST_CASE("mirror sphere: nothing beside the sphere is read, up to its rim") {
  const mirror_sphere sphere;
  for (const std::size_t pixels : {8u, 9u, 64u, 101u}) {
    const auto white = [](const gonio::direction&) { return gonio::rgb(1.0, 1.0, 1.0); };
    const auto map = unwrap(lab::photograph(sphere, white, pixels), sphere, {.rows = 32});
    CHECK(*std::min_element(map.begin(), map.end()) == 1.0f);
    CHECK(*std::max_element(map.begin(), map.end()) == 1.0f);
  }
}

TEST_CASE("mirror sphere: bad input is refused") {
  using doctest::Contains;
  CHECK_THROWS_WITH_AS(mirror_sphere(1.0), Contains("outside the mirror sphere"), gonio::error);
  CHECK_THROWS_WITH_AS(mirror_sphere(std::nan("")), Contains("outside the mirror sphere"), gonio::error);
  CHECK_THROWS_WITH_AS(mirror_sphere::spanning(4.0), Contains("between 0 and 180"), gonio::error);
  const auto grey = gonio::uniform_image(16, 16, gonio::rgb::Constant(0.5));
  CHECK_THROWS_WITH_AS(unwrap(gonio::uniform_image(16, 20), {}), Contains("not 16 x 20"), gonio::error);
  CHECK_THROWS_WITH_AS(unwrap(gonio::uniform_image(4, 4), {}), Contains("8 pixels"), gonio::error);
  CHECK_THROWS_WITH_AS(unwrap(grey, {}, {.rows = 0}), Contains("at least one row"), gonio::error);
  CHECK_THROWS_WITH_AS(unwrap(grey, {}, {.reflectance = 0.0}), Contains("reflectance"), gonio::error);
  auto bad = grey;
  bad(3, 3, 0) = std::nanf("");
  CHECK_THROWS_WITH_AS(unwrap(bad, {}), Contains("must be finite"), gonio::error);
}
