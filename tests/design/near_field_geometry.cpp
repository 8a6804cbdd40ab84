#include <gonio/design/near_field_geometry.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <functional>

using gonio::degrees;
using gonio::radians;
using gonio::design::near_field_geometry;

namespace {

/// Returns the candidate with these polar angles of light and camera and this azimuth between them, in degrees.
Eigen::Index candidate_at(const near_field_geometry& geometry, double light, double camera, double azimuth) {
  return geometry.nearest(
      {gonio::spherical_direction(radians(light), radians(azimuth)), gonio::spherical_direction(radians(camera), 0.0)});
}

}  // namespace

TEST_CASE("a candidate is where it says, and nearest finds it again") {
  const near_field_geometry geometry({.step = radians(5)});
  CHECK(geometry.size() == 18 * 18 * 37);
  for (Eigen::Index candidate = 0; candidate < geometry.size(); ++candidate)
    if (geometry.allows(candidate)) REQUIRE(geometry.nearest(geometry.centre(candidate)) == candidate);
  const auto pose = geometry.centre(candidate_at(geometry, 30, 45, 180));
  CHECK(degrees(std::acos(pose.wi.z())) == doctest::Approx(30));
  CHECK(degrees(std::acos(pose.wo.z())) == doctest::Approx(45));
  CHECK(pose.wi.x() < 0.0);
  CHECK(pose.wo.x() > 0.0);
}

TEST_CASE("from the zenith the pixels see a cone of the field of view, all under the same light") {
  const near_field_geometry geometry({.field_of_view = radians(25), .pixels = 60});
  const auto seen = geometry.directions(candidate_at(geometry, 40, 0, 0));
  // The disc's diameter is 60 r / tan(asin r) pixels with r = tan(12.5 degrees): nearly pi / 4 of the square.
  CHECK(seen.size() > 2500);
  CHECK(seen.size() < 3000);
  double steepest = 1.0, flattest = 0.0;
  for (const auto& angles : seen) {
    // Folded angles do not distinguish light and camera; here the light is the lower one.
    const auto [one, other] = gonio::cosines(angles);
    CHECK(std::min(one, other) == doctest::Approx(std::cos(radians(40))));
    steepest = std::min(steepest, std::max(one, other));
    flattest = std::max(flattest, std::max(one, other));
  }
  CHECK(degrees(std::acos(flattest)) < 0.5);
  CHECK(degrees(std::acos(steepest)) == doctest::Approx(12.5).epsilon(0.04));
  // Even the centres of the outermost of 3 x 3 pixels are in the disc.
  const near_field_geometry coarse({.field_of_view = radians(25), .pixels = 3});
  CHECK(coarse.directions(candidate_at(coarse, 40, 0, 0)).size() == 9);
}

TEST_CASE("a disc seen from the side is an ellipse of fewer pixels, its near side at another angle than its far one") {
  const near_field_geometry geometry({.field_of_view = radians(25), .pixels = 60});
  const auto from_above = geometry.directions(candidate_at(geometry, 40, 0, 0)),
             from_aside = geometry.directions(candidate_at(geometry, 40, 60, 90));
  CHECK(static_cast<double>(from_aside.size()) ==
        doctest::Approx(0.5 * static_cast<double>(from_above.size())).epsilon(0.1));
  double smallest = 90.0, largest = 0.0;
  for (const auto& angles : from_aside) {
    const auto [one, other] = gonio::cosines(angles);  // here the camera is the lower one
    const double theta_o = degrees(std::acos(std::min(one, other)));
    smallest = std::min(smallest, theta_o);
    largest = std::max(largest, theta_o);
  }
  // r = tan(12.5 degrees), camera at (sin 60, 0, cos 60): it sees the near edge at atan((sin 60 - r) / cos 60).
  const double r = std::tan(radians(12.5));
  CHECK(smallest == doctest::Approx(degrees(std::atan((std::sin(radians(60)) - r) / 0.5))).epsilon(0.01));
  CHECK(largest == doctest::Approx(degrees(std::atan((std::sin(radians(60)) + r) / 0.5))).epsilon(0.01));
}

TEST_CASE("every pixel is above the horizon, whatever the candidate") {
  const near_field_geometry geometry({.field_of_view = radians(45), .pixels = 9});
  CHECK(rc::check([&] {
    const auto candidate = *rc::gen::inRange<Eigen::Index>(0, geometry.size());
    if (!geometry.allows(candidate)) return;
    const auto seen = geometry.directions(candidate);
    RC_ASSERT(!seen.empty());
    for (const auto& angles : seen) {
      RC_ASSERT(gonio::cosines(angles).i > 0.0);
      RC_ASSERT(gonio::cosines(angles).o > 0.0);
    }
  }));
}

TEST_CASE("steps there and back; nothing beyond the ends; one azimuth at the zenith") {
  const near_field_geometry geometry;
  const Eigen::Index from = candidate_at(geometry, 30, 45, 90);
  for (const gonio::design::grid_step& step : {gonio::design::grid_step{3, 0, 0}, {0, -1, 0}, {0, 0, 3}}) {
    const auto to = geometry.stepped(from, step);
    REQUIRE(to.has_value());
    CHECK(geometry.stepped(*to, {-step[0], -step[1], -step[2]}) == from);
  }
  CHECK_FALSE(geometry.stepped(candidate_at(geometry, 85, 45, 90), {1, 0, 0}).has_value());
  CHECK_FALSE(geometry.stepped(candidate_at(geometry, 30, 0, 0), {0, 0, 1}).has_value());
}

TEST_CASE("a fixed camera or light is where it is fixed") {
  const near_field_geometry camera({.fixed_camera = radians(64)}), light({.fixed_light = radians(33)});
  CHECK(camera.size() == 18 * 37);
  for (Eigen::Index candidate = 0; candidate < camera.size(); candidate += 11)
    CHECK(degrees(std::acos(camera.centre(candidate).wo.z())) == doctest::Approx(64));
  for (Eigen::Index candidate = 0; candidate < light.size(); candidate += 11)
    CHECK(degrees(std::acos(light.centre(candidate).wi.z())) == doctest::Approx(33));
}

TEST_CASE("constraints hold for the centre of the image") {
  gonio::design::capture_constraint constraint;
  constraint.light_step = radians(15);
  constraint.smallest_separation = radians(20);
  const near_field_geometry geometry({.constraint = constraint});
  for (Eigen::Index candidate = 0; candidate < geometry.size(); ++candidate)
    if (geometry.allows(candidate)) REQUIRE(constraint(geometry.centre(candidate)));
}

TEST_CASE("what cannot be built is refused") {
  const auto refused = [](const std::function<void(gonio::design::near_field_options&)>& change, const char* why) {
    gonio::design::near_field_options options;
    change(options);
    CHECK_THROWS_WITH_AS(near_field_geometry{options}, doctest::Contains(why), gonio::error);
  };
  refused([](auto& o) { o.field_of_view = 0.0; }, "field of view");
  refused([](auto& o) { o.field_of_view = radians(90); }, "field of view");
  refused([](auto& o) { o.pixels = 0; }, "pixels");
  refused([](auto& o) { o.step = 0.0; }, "step");
  refused([](auto& o) { o.largest_polar_angle = radians(90); }, "largest polar angle");
  refused([](auto& o) { o.fixed_camera = radians(95); }, "above the horizon");
  refused([](auto& o) { o.constraint.smallest_separation = 4.0; }, "limits of the apparatus");
}
