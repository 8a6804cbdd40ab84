#include <gonio/capture/trajectory.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <random>
#include <set>

using gonio::direction;
using gonio::capture::camera_sphere;

namespace {

std::vector<direction> scattered(std::size_t count, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> theta(0.0, 1.5), phi(0.0, 3.1);
  std::vector<direction> found;
  for (std::size_t i = 0; i < count; ++i) found.push_back(gonio::spherical_direction(theta(generator), phi(generator)));
  return found;
}

}  // namespace

TEST_CASE("trajectory: Eq. 1-5, and the camera looks at the sample") {
  const camera_sphere sphere{{100.0, -20.0, 600.0}, 350.0, 0.0};
  const auto pose = sphere.towards(gonio::spherical_direction(gonio::radians(30.0), gonio::radians(60.0)));
  CHECK(pose.position.x() == doctest::Approx(100.0 + 350.0 * 0.5 * 0.5));
  CHECK(pose.position.y() == doctest::Approx(-20.0 + 350.0 * 0.5 * std::sqrt(0.75)));
  CHECK(pose.position.z() == doctest::Approx(600.0 + 350.0 * std::sqrt(0.75)));
  CHECK(gonio::degrees(pose.pitch) == doctest::Approx(120.0));
  CHECK(gonio::degrees(pose.yaw) == doctest::Approx(60.0));
  CHECK(rc::check("the camera looks at the centre from where it should be, with the arc along y as well", [] {
    const auto wo = scattered(1, *rc::gen::arbitrary<unsigned>()).front();
    const camera_sphere here{{1.0, 2.0, 3.0}, 350.0, *rc::gen::inRange(0, 360) * 0.0175};
    const auto at = here.towards(wo);
    RC_ASSERT((at.position + 350.0 * at.looks_along() - here.centre).norm() < 1e-9);
    RC_ASSERT(std::abs(at.orientation().norm() - 1.0) < 1e-12);
    RC_ASSERT((here.seen_from(at) - wo).norm() < 1e-9);
  }));
  // The arc's azimuth 0 is the robot's y axis.
  const auto along_arc = camera_sphere{}.towards(gonio::spherical_direction(gonio::radians(45.0), 0.0));
  CHECK(std::abs(along_arc.position.x()) < 1e-9);
  CHECK(along_arc.position.y() == doctest::Approx(350.0 * std::sqrt(0.5)));
}

TEST_CASE("trajectory: poses of a tool lead back to the directions, and their quaternions do not jump") {
  CHECK(rc::check("position and orientation are two ways back", [] {
    const auto directions = scattered(20, *rc::gen::arbitrary<unsigned>());
    const camera_sphere sphere{{10.0, 20.0, 300.0}, 500.0, *rc::gen::inRange(-360, 360) * 0.0175};
    const auto path = gonio::capture::tool_path(sphere, directions);
    RC_ASSERT(path.size() == directions.size());
    RC_ASSERT(path.front().quaternion[0] >= 0.0);
    for (std::size_t i = 0; i < path.size(); ++i) {
      const direction from_position = (path[i].position - sphere.centre).normalized();
      for (const direction& back : {from_position, direction(-path[i].looks_along())})
        RC_ASSERT((gonio::turned_about_normal(back, -sphere.arc_azimuth) - directions[i]).norm() < 1e-9);
      RC_ASSERT(std::abs(path[i].quaternion.norm() - 1.0) < 1e-12);
      if (i > 0) RC_ASSERT(path[i].quaternion.dot(path[i - 1].quaternion) >= 0.0);
    }
  }));
  // A pose known by hand: from 30 degrees above x, the tool's x turns by 120 degrees about y.
  const std::vector one{gonio::spherical_direction(gonio::radians(30.0), 0.0)};
  const auto pose = gonio::capture::tool_path({.arc_azimuth = 0.0}, one).front();
  CHECK((pose.quaternion - Eigen::Vector4d(0.5, 0.0, std::sqrt(0.75), 0.0)).norm() < 1e-12);
  // A full circle: the orientation changes in steps as small as the directions', and returns; the quaternion q ends at
  // -q.
  std::vector<direction> circle;
  for (int i = 0; i <= 360; ++i) circle.push_back(gonio::spherical_direction(0.7, gonio::radians(i)));
  const auto round = gonio::capture::tool_path({}, circle);
  for (std::size_t i = 1; i < round.size(); ++i)
    CHECK((round[i].quaternion - round[i - 1].quaternion).norm() < gonio::radians(1.0));
  CHECK((round.front().quaternion + round.back().quaternion).norm() < 1e-9);
  CHECK_THROWS_WITH_AS(gonio::capture::tool_path({.radius = 0.0}, one), doctest::Contains("positive radius"),
                       gonio::error);
}

TEST_CASE("trajectory: 11 rows of 25, and right above; 23 lamps") {
  const auto seen = gonio::capture::half_hemisphere();
  CHECK(seen.size() == 11 * 25 + 1);
  CHECK(gonio::degrees(gonio::polar_angle(seen.front())) == doctest::Approx(82.5));
  for (const direction& wo : seen) CHECK(wo.y() >= -1e-12);
  const auto lamps = gonio::capture::arc_lamps();
  CHECK(lamps.size() == 23);
  for (const direction& wi : lamps) {
    CHECK(std::abs(wi.y()) < 1e-12);
    CHECK(wi.z() > 0.1);
  }
  CHECK_THROWS_WITH_AS(gonio::capture::arc_lamps({gonio::radians(7.0)}), doctest::Contains("7.000000 degrees"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(gonio::capture::half_hemisphere({0.0}), doctest::Contains("do not divide"), gonio::error);
  // For one lamp, the largest allowed step is a right angle.
  CHECK(gonio::capture::arc_lamps({gonio::radians(90.0)}).size() == 1);
  CHECK_THROWS_WITH_AS(gonio::capture::arc_lamps({gonio::radians(180.0)}), doctest::Contains("do not divide"),
                       gonio::error);
}

TEST_CASE("trajectory: a pair above the arc is the same pair to an isotropic material") {
  CHECK(rc::check("angles stay, the light is above x, the viewer on one side", [] {
    const auto two = scattered(2, *rc::gen::arbitrary<unsigned>());
    const double turn = *rc::gen::inRange(0, 628) / 100.0;
    const gonio::direction_pair pair{gonio::turned_about_normal(two[0], turn),
                                     gonio::turned_about_normal(two[1], turn)};
    const auto turned = gonio::capture::above_arc(pair);
    RC_ASSERT(std::abs(turned.wi.y()) < 1e-12);
    RC_ASSERT(turned.wi.x() >= 0.0);
    RC_ASSERT(turned.wo.y() >= 0.0);
    RC_ASSERT(std::abs(turned.wi.z() - pair.wi.z()) < 1e-12);
    RC_ASSERT(std::abs(turned.wo.z() - pair.wo.z()) < 1e-12);
    RC_ASSERT(std::abs(turned.wi.dot(turned.wo) - pair.wi.dot(pair.wo)) < 1e-12);
  }));
  const auto above = gonio::capture::above_arc({direction::UnitZ(), gonio::spherical_direction(0.5, 2.0)});
  CHECK((above.wo - gonio::spherical_direction(0.5, 0.0)).norm() < 1e-12);
}

TEST_CASE("trajectory: every pose once, on a path that no reversed section shortens") {
  CHECK(rc::check("a way of scattered directions", [] {
    const auto directions = scattered(*rc::gen::inRange<std::size_t>(1, 25), *rc::gen::arbitrary<unsigned>());
    const auto order = gonio::capture::short_way(directions);
    RC_ASSERT(std::set<Eigen::Index>(order.begin(), order.end()).size() == directions.size());
    RC_ASSERT(order.front() == 0u);
    const double length = gonio::capture::length_of_way(directions, order);
    for (std::size_t i = 1; i < order.size(); ++i)
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        auto other = order;
        std::reverse(other.begin() + static_cast<std::ptrdiff_t>(i),
                     other.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        RC_ASSERT(gonio::capture::length_of_way(directions, other) > length - 1e-8);
      }
  }));
  CHECK(gonio::capture::short_way({}).empty());
}

TEST_CASE("trajectory: the note's scan takes about its three hours") {
  const auto seen = gonio::capture::half_hemisphere();
  const auto order = gonio::capture::short_way(seen);
  std::vector<Eigen::Index> as_listed(seen.size());
  std::iota(as_listed.begin(), as_listed.end(), std::size_t{0});
  CHECK(gonio::capture::length_of_way(seen, order) < 0.85 * gonio::capture::length_of_way(seen, as_listed));
  const double hours = gonio::capture::duration_of_scan(gonio::capture::length_of_way(seen, order), seen.size(),
                                                        gonio::capture::arc_lamps().size()) /
                       3600.0;
  CHECK(hours > 2.0);
  CHECK(hours < 3.5);
  CHECK_THROWS_WITH_AS((void)gonio::capture::duration_of_scan(1.0, 1, 23, {.radians_per_second = 0.0}),
                       doctest::Contains("speed"), gonio::error);
}
