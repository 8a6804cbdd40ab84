#include <gonio/capture/light_probe.hpp>
#include <gonio/render/environment_map.hpp>

#include <doctest/doctest.h>
#include <lab/mirror_sphere_lab.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

using gonio::radians;
using gonio::capture::camera_axes;
using gonio::capture::light_probe;
using gonio::capture::mirror_sphere;
using gonio::capture::unwrap;

namespace {

/// Returns the mean relative error of a map, weighted by solid angle, over world directions at most this angle from
/// `towards`.
double mean_relative_error(const gonio::render::environment_map& truth, const gonio::image& found, double largest_angle,
                           const gonio::direction& towards = gonio::direction::UnitZ()) {
  double sum = 0.0, weights = 0.0;
  for (std::size_t row = 0; row < truth.rows(); ++row)
    for (std::size_t column = 0; column < truth.columns(); ++column) {
      if (gonio::angle_between(truth.towards(row, column), towards) > largest_angle) continue;
      const gonio::rgb expected = gonio::pixel(truth.image(), row, column);
      sum += truth.solid_angle(row) * ((gonio::pixel(found, row, column) - expected).abs() / expected).mean();
      weights += truth.solid_angle(row);
    }
  return sum / weights;
}

}  // namespace
TEST_CASE("light probe: a map, its image in the sphere, and back") {
  const auto truth = gonio::render::environment_map::of(gonio::render::formula_environment{}, 64);
  for (const mirror_sphere& sphere : {mirror_sphere(), mirror_sphere(4.0), mirror_sphere(20.0)}) {
    const auto probe = lab::photograph(sphere, truth, lab::probe_view::square(512));
    const auto map = unwrap(probe, sphere, {.rows = 64});
    const double visible = sphere.largest_polar_angle() - gonio::radians(10.0);
    CHECK(mean_relative_error(truth, map, visible) < 0.02);
    // Unwrapping by the wrong sphere gives a clear error.
    CHECK(mean_relative_error(truth, unwrap(probe, mirror_sphere(2.0), {.rows = 64}), visible) > 0.02);
  }
  const mirror_sphere sphere(4.0);
  const auto probe = lab::photograph(sphere, truth, lab::probe_view::square(256));
  CHECK(unwrap(probe, sphere, {.rows = 32}, gonio::thread_count{1}) ==
        unwrap(probe, sphere, {.rows = 32}, gonio::thread_count{3}));
  const gonio::image bright = unwrap(probe, sphere, {.rows = 32, .reflectance = 0.5});
  CHECK(bright(10, 10, 1) == doctest::Approx(2.0 * unwrap(probe, sphere, {.rows = 32})(10, 10, 1)));
}

TEST_CASE("light probe: a map is as symmetric as the light") {
  const auto symmetric = [](const gonio::direction& from) {
    return gonio::rgb::Constant(2.0 + from.z() + from.x() * from.x() - 0.5 * from.y() * from.y());
  };
  const mirror_sphere sphere(4.0);
  for (const std::size_t rows : {8u, 64u}) {
    const auto map = unwrap(lab::photograph(sphere, symmetric, lab::probe_view::square(128)), sphere, {.rows = rows});
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t column = 0; column < 2 * rows; ++column) {
        const double here = map(row, column, 1);
        REQUIRE(map(row, 2 * rows - 1 - column, 1) == doctest::Approx(here).epsilon(1e-4));
        REQUIRE(map(rows - 1 - row, column, 1) == doctest::Approx(here).epsilon(1e-4));
      }
  }
}

TEST_CASE("light probe: nothing beside the sphere is read, up to its rim") {
  const mirror_sphere sphere;
  for (const std::size_t pixels : {8u, 9u, 64u, 101u}) {
    const auto white = [](const gonio::direction&) { return gonio::rgb(1.0, 1.0, 1.0); };
    const auto map = unwrap(lab::photograph(sphere, white, lab::probe_view::square(pixels)), sphere, {.rows = 32});
    CHECK(*std::min_element(map.begin(), map.end()) == 1.0f);
    CHECK(*std::max_element(map.begin(), map.end()) == 1.0f);
  }
}

TEST_CASE("light probe: a camera in any direction gives the same map") {
  const auto truth = gonio::render::environment_map::of(gonio::render::formula_environment{}, 64);
  const mirror_sphere sphere(6.0);
  const auto error_of = [&](const Eigen::Matrix3d& seen_from, const Eigen::Matrix3d& believed) {
    lab::probe_view view = lab::probe_view::square(512);
    view.axes = seen_from;
    light_probe probe = lab::probe(sphere, truth, view);
    probe.axes = believed;
    const gonio::image map = unwrap({&probe, 1}, {.rows = 64});
    return mean_relative_error(truth, map, sphere.largest_polar_angle() - radians(10.0), seen_from.col(2));
  };
  for (const auto& [azimuth, elevation, roll] :
       {std::array{90.0, 0.0, 0.0}, {-140.0, 35.0, 0.0}, {20.0, -70.0, 0.0}, {10.0, 90.0, 0.0}, {60.0, 10.0, 25.0}}) {
    const Eigen::Matrix3d axes = camera_axes(radians(azimuth), radians(elevation), radians(roll));
    CHECK((axes.transpose() * axes).isIdentity(1e-12));
    CHECK(axes.determinant() == doctest::Approx(1.0));
    CHECK(error_of(axes, axes) < 0.02);
    CHECK(error_of(axes, axes * camera_axes(0.0, 0.0, radians(5.0))) > 0.03);
  }
  // Eq. 8: a level camera at +x sees -z to its right and +y upwards.
  Eigen::Matrix3d expected;
  expected << 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0;
  CHECK((camera_axes(radians(90.0), 0.0) - expected).norm() < 1e-12);
  CHECK((camera_axes(0.0, 0.0, radians(90.0)) * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm() < 1e-12);
}

TEST_CASE("light probe: the sphere is found in an image with a margin") {
  // A lamp is ten thousand times as bright as the rest, which must not hide a dark rim.
  const auto truth = gonio::render::environment_map::of(
      [](const gonio::direction& d) -> gonio::rgb {
        const double lamp = gonio::angle_between(d, gonio::direction(0.6, 0.0, 0.8)) < radians(4.0) ? 1e4 : 0.0;
        return gonio::rgb::Constant(1.0 + 0.9 * d.y() * d.z() + lamp);
      },
      64);
  const mirror_sphere sphere(8.0);
  for (const auto& outline : {gonio::capture::outline_circle{200.3, 150.7, 120.4}, {340.0, 170.2, 101.9}}) {
    const lab::probe_view view{.rows = 320, .columns = 480, .outline = outline};
    light_probe probe = lab::probe(sphere, truth, view);
    probe.outline = gonio::capture::find_outline(probe.photograph);
    CHECK(std::abs(probe.outline.column - outline.column) < 0.15);
    CHECK(std::abs(probe.outline.row - outline.row) < 0.15);
    CHECK(std::abs(probe.outline.radius - outline.radius) < 0.15);
    const gonio::image found = unwrap({&probe, 1}, {.rows = 32});
    probe.outline = outline;
    const gonio::render::environment_map exact(unwrap({&probe, 1}, {.rows = 32}));
    CHECK(mean_relative_error(exact, found, sphere.largest_polar_angle() - radians(10.0)) < 0.01);
  }
  CHECK_THROWS_WITH_AS(gonio::capture::find_outline(gonio::uniform_image(64, 64)), doctest::Contains("no sphere"),
                       gonio::error);
}

TEST_CASE("light probe: two probes merged have neither seam nor photographer") {
  // Stripes and lamps, so that stretched and misplaced light counts.
  const auto radiance = [](const gonio::direction& d) -> gonio::rgb {
    const double stripes = 1.0 + 0.5 * std::sin(14.0 * std::atan2(d.x(), d.z())) * std::sqrt(1.0 - d.y() * d.y());
    return gonio::rgb(1.0, 0.8, 0.6) * stripes * (1.2 + d.y()) + gonio::render::formula_environment{}(d);
  };
  const auto truth = gonio::render::environment_map::of(radiance, 64);
  const mirror_sphere sphere(10.0);
  std::vector<light_probe> probes;
  for (const double azimuth : {0.0, 90.0}) {
    lab::probe_view view = lab::probe_view::square(512, 0.1);
    view.axes = camera_axes(radians(azimuth), 0.0);
    view.photographer = radians(12.0);
    probes.push_back(lab::probe(sphere, radiance, view));
  }
  const double everywhere = std::numbers::pi;
  const gonio::image one = unwrap(std::span(probes).first(1), {.rows = 64}), both = unwrap(probes, {.rows = 64});
  const double error_of_one = mean_relative_error(truth, one, everywhere),
               error_of_both = mean_relative_error(truth, both, everywhere);
  MESSAGE("mean relative error over all directions: one probe " << error_of_one << ", both " << error_of_both);
  const auto towards = [](double azimuth) { return camera_axes(radians(azimuth), 0.0).col(2).eval(); };
  for (const double azimuth : {0.0, 90.0, 180.0, 270.0}) {
    const double near_one = mean_relative_error(truth, one, radians(15.0), towards(azimuth)),
                 near_both = mean_relative_error(truth, both, radians(15.0), towards(azimuth));
    MESSAGE("within 15 degrees of azimuth " << azimuth << ": one probe " << near_one << ", both " << near_both);
    CHECK(near_both < 0.05);
  }
  CHECK(error_of_both < 0.5 * error_of_one);
  CHECK(unwrap(probes, {.rows = 16}, gonio::thread_count{1}) == unwrap(probes, {.rows = 16}, gonio::thread_count{3}));
}

TEST_CASE("light probe: light that all photographs hide is filled") {
  const auto grey = [](const gonio::direction&) { return gonio::rgb(0.5, 0.5, 0.5); };
  lab::probe_view view = lab::probe_view::square(64);
  std::vector<light_probe> probes(2, lab::probe(mirror_sphere(3.0), grey, view));
  for (light_probe& each : probes) each.photographer = radians(20.0);
  const gonio::image map = unwrap(probes, {.rows = 16});
  CHECK(*std::min_element(map.begin(), map.end()) == 0.5f);
  CHECK(*std::max_element(map.begin(), map.end()) == 0.5f);
}

TEST_CASE("light probe: bad input is refused") {
  using doctest::Contains;
  const auto grey = gonio::uniform_image(16, 16, gonio::rgb::Constant(0.5));
  CHECK_THROWS_WITH_AS(unwrap(gonio::uniform_image(16, 20), {}), Contains("not 16 x 20"), gonio::error);
  CHECK_THROWS_WITH_AS(unwrap(gonio::uniform_image(4, 4), {}), Contains("8 pixels"), gonio::error);
  CHECK_THROWS_WITH_AS(unwrap(grey, {}, {.rows = 0}), Contains("at least one row"), gonio::error);
  CHECK_THROWS_WITH_AS(unwrap(grey, {}, {.reflectance = 0.0}), Contains("reflectance"), gonio::error);
  auto bad = grey;
  bad(3, 3, 0) = std::nanf("");
  CHECK_THROWS_WITH_AS(unwrap(bad, {}), Contains("must be finite"), gonio::error);
  const auto with = [&](const auto& change) {
    light_probe probe{.photograph = grey, .outline = {8.0, 8.0, 6.0}};
    change(probe);
    return unwrap({&probe, 1}, {.rows = 4});
  };
  with([&](light_probe& probe) { probe.photograph(0, 0, 0) = std::nanf(""); });  // beside the sphere
  CHECK_THROWS_WITH_AS(with([](light_probe& probe) { probe.outline.column = 1.0; }), Contains("all of it"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(with([](light_probe& probe) { probe.outline.radius = 3.0; }), Contains("8 pixels"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(with([](light_probe& probe) { probe.axes.col(0) *= 2.0; }), Contains("rotation"), gonio::error);
  CHECK_THROWS_WITH_AS(with([](light_probe& probe) { probe.photographer = 2.0; }), Contains("0 to 90"), gonio::error);
  CHECK_THROWS_WITH_AS(unwrap(std::span<const light_probe>()), Contains("at least one photograph"), gonio::error);
  CHECK_THROWS_WITH_AS(camera_axes(std::nan(""), 0.0), Contains("finite"), gonio::error);
}
