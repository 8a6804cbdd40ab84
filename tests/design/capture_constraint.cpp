#include <gonio/design/apparatus.hpp>
#include <gonio/design/capture_geometry.hpp>

#include <doctest/doctest.h>

using gonio::direction_pair;
using gonio::radians;
using gonio::spherical_direction;
using gonio::design::capture_constraint;

namespace {

/// Light and viewer at these polar angles and this difference of azimuths, in degrees.
direction_pair light_and_viewer(double light, double viewer, double azimuth = 0.0) {
  return {spherical_direction(radians(light), radians(azimuth)), spherical_direction(radians(viewer), 0.0)};
}

}  // namespace

TEST_CASE("without a constraint everything is allowed") {
  const capture_constraint none;
  CHECK(none.is_none());
  CHECK(none(light_and_viewer(89.9, 0)));
  CHECK(none(light_and_viewer(30, 30)));
}

TEST_CASE("lights and viewers stay in their ranges") {
  capture_constraint constraint;
  constraint.light = {radians(10), radians(60)};
  constraint.viewer.largest = radians(70);
  CHECK_FALSE(constraint.is_none());
  CHECK(constraint(light_and_viewer(30, 69)));
  CHECK_FALSE(constraint(light_and_viewer(9, 69)));
  CHECK_FALSE(constraint(light_and_viewer(61, 69)));
  CHECK_FALSE(constraint(light_and_viewer(30, 71)));
}

TEST_CASE("light and viewer keep their distance, on whichever side they are") {
  capture_constraint constraint;
  constraint.smallest_separation = radians(15);
  CHECK_FALSE(constraint(light_and_viewer(40, 30)));
  CHECK(constraint(light_and_viewer(46, 30)));
  CHECK(constraint(light_and_viewer(10, 10, 180)));
  CHECK_FALSE(constraint(light_and_viewer(7, 7, 180)));
  CHECK_FALSE(constraint(light_and_viewer(0, 0)));
}

TEST_CASE("lights on an arc stand at multiples of a step") {
  capture_constraint constraint;
  constraint.light_step = radians(7.5);
  for (const double light : {0.0, 7.5, 22.4, 45.4}) CHECK(constraint(light_and_viewer(light, 20)));
  for (const double light : {3.0, 8.1, 44.0}) CHECK_FALSE(constraint(light_and_viewer(light, 20)));
}

TEST_CASE("a zone is forbidden where both are in it") {
  capture_constraint constraint;
  constraint.forbidden = {{{radians(60), radians(90)}, {radians(60), radians(90)}}};
  CHECK_FALSE(constraint(light_and_viewer(70, 65, 180)));
  CHECK(constraint(light_and_viewer(70, 50, 180)));
  CHECK(constraint(light_and_viewer(50, 65, 180)));
}

TEST_CASE("in the plane of incidence: poses are checked against it, and those next to it are moved into it") {
  capture_constraint constraint;
  constraint.plane_tolerance = radians(1);
  CHECK_FALSE(constraint.is_none());
  CHECK(constraint(light_and_viewer(30, 60, 180)));
  CHECK(constraint(light_and_viewer(30, 60)));
  CHECK(constraint(light_and_viewer(0, 60, 77)));
  CHECK_FALSE(constraint(light_and_viewer(30, 60, 175)));
  // The polar angle of the light does not matter.
  CHECK_FALSE(constraint(light_and_viewer(10, 60, 178)));
  CHECK(constraint(light_and_viewer(10, 60, 179)));
  const auto pose = constraint.pose_of({radians(20), radians(30), radians(8)});
  REQUIRE(pose);
  CHECK(gonio::to_half_difference(pose->wi, pose->wo).theta_h == doctest::Approx(radians(20)));
  CHECK(std::abs(pose->wi.x() * pose->wo.y() - pose->wi.y() * pose->wo.x()) < 1e-12);
}

TEST_CASE("an instrument with fixed pairs measures these, turned about the normal or exchanged, and no others") {
  capture_constraint constraint;
  constraint.pairs = {light_and_viewer(45, 20, 180), light_and_viewer(45, 30)};
  CHECK_FALSE(constraint.is_none());
  CHECK(constraint.fixed_pair(light_and_viewer(45, 20, 180)) == 0);
  CHECK(constraint.fixed_pair(light_and_viewer(30, 45)) == 1);
  CHECK(constraint({spherical_direction(radians(45.3), radians(77)), spherical_direction(radians(20), radians(257))}));
  CHECK_FALSE(constraint(light_and_viewer(45, 20)));
  CHECK_FALSE(constraint(light_and_viewer(45, 20, 175)));
  CHECK_FALSE(constraint(light_and_viewer(46, 20, 180)));
  CHECK(constraint.excluding_rule([](const capture_constraint& some) { return some.pairs.empty(); }) == "pair");

  const gonio::design::point_geometry points{gonio::valid_cells(gonio::grid({24, 15, 12})), constraint};
  std::vector<direction_pair> allowed;
  for (Eigen::Index cell = 0; cell < points.size(); ++cell)
    if (points.allows(cell)) allowed.push_back(points.centre(cell));
  REQUIRE(allowed.size() == 2);
  for (const direction_pair& pair : allowed) {
    const auto found = constraint.fixed_pair(pair);
    REQUIRE(found);
    CHECK(pair.wi.isApprox(constraint.pairs[*found].wi));
    CHECK(pair.wo.isApprox(constraint.pairs[*found].wo));
  }
}

TEST_CASE("a usual apparatus keeps light and viewer from grazing and from one another") {
  const gonio::design::apparatus usual = gonio::design::usual_apparatus();
  CHECK(usual.constraint(light_and_viewer(79, 79, 180)));
  CHECK_FALSE(usual.constraint(light_and_viewer(81, 20, 180)));
  CHECK_FALSE(usual.constraint(light_and_viewer(40, 36)));
  CHECK(usual.noise > 0.0);
  CHECK(usual.dark_signal > 0.0);
}

TEST_CASE("the rule that leaves nothing is named") {
  capture_constraint constraint;
  constraint.light = {radians(45), radians(45)};
  constraint.smallest_separation = radians(10);
  const auto light_must_be_a_range = [](const capture_constraint& some) {
    return some.light.largest > some.light.smallest;
  };
  CHECK(constraint.excluding_rule(light_must_be_a_range) == "light");
  const auto must_be_apart = [](const capture_constraint& some) { return some.smallest_separation < radians(5); };
  CHECK(constraint.excluding_rule(must_be_apart) == "separation");
  CHECK(constraint.excluding_rule([](const capture_constraint&) { return true; }).empty());
}
