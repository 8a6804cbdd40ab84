#include <gonio/core/error.hpp>
#include <gonio/table/aperture.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>

using gonio::aperture, gonio::direction, gonio::direction_pair, gonio::radians;

namespace {

direction_pair around(double theta_i, double theta_o) {
  return {gonio::spherical_direction(radians(theta_i), 0.3), gonio::spherical_direction(radians(theta_o), 2.0)};
}

}  // namespace

TEST_CASE("pairs lie within both cones, as many in each equal part of either") {
  CHECK(rc::check([] {
    const direction_pair axes = around(*rc::gen::inRange(0, 40), *rc::gen::inRange(0, 40));
    const aperture cones{radians(*rc::gen::inRange(1, 45)), radians(*rc::gen::inRange(1, 45))};
    constexpr int count = 256;
    const auto pairs = gonio::pairs_within(axes, cones, count);
    RC_ASSERT(std::ssize(pairs) == count);
    direction mean_light = direction::Zero(), mean_receiver = direction::Zero();
    int inner = 0, both_inner = 0;
    const auto is_inner = [](const direction& w, const direction& axis, double half_angle) {
      return w.dot(axis) > 0.5 + 0.5 * std::cos(half_angle);  // the inner half of the solid angle
    };
    for (const auto& [wi, wo] : pairs) {
      RC_ASSERT(gonio::angle_between(wi, axes.wi) <= cones.source + 1e-9);
      RC_ASSERT(gonio::angle_between(wo, axes.wo) <= cones.receiver + 1e-9);
      mean_light += wi / count;
      mean_receiver += wo / count;
      const bool light = is_inner(wi, axes.wi, cones.source), receiver = is_inner(wo, axes.wo, cones.receiver);
      inner += receiver ? 1 : 0;
      both_inner += light && receiver ? 1 : 0;
    }
    RC_ASSERT(gonio::angle_between(mean_light, axes.wi) < 0.02 * cones.source);
    RC_ASSERT(gonio::angle_between(mean_receiver, axes.wo) < 0.02 * cones.receiver);
    RC_ASSERT(inner == count / 2);
    RC_ASSERT(std::abs(both_inner - count / 4) <= 5);  // the directions in the two cones are independent
  }));
}

TEST_CASE("the mean over cones is the integral: of a cosine it is known") {
  const direction_pair axes = around(0.0, 0.0);
  for (const double half_angle : {0.1, 0.4, 0.7}) {
    const auto cosine = [](const direction&, const direction& wo) { return wo.z(); };
    const double mean = gonio::mean_within(axes, {0.0, half_angle}, 256, cosine);
    CHECK(mean == doctest::Approx(0.5 * (1.0 + std::cos(half_angle))).epsilon(1e-12));
  }
}

TEST_CASE("the half angle of a cone of a solid angle") {
  CHECK(gonio::half_angle_of(0.0) == 0.0);
  CHECK(gonio::half_angle_of(2.0 * std::numbers::pi * (1.0 - std::cos(0.3))) == doctest::Approx(0.3));
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::half_angle_of(2.0)), doctest::Contains("solid angle of 2"),
                       gonio::error);
  CHECK_THROWS_AS(static_cast<void>(gonio::half_angle_of(-0.1)), gonio::error);
}

TEST_CASE("no cones are one direction, and directions below the horizon are left out") {
  const direction_pair axes = around(20.0, 88.0);
  for (const auto& [wi, wo] : gonio::pairs_within(axes, {}, 16)) {
    CHECK((wi - axes.wi).norm() < 1e-12);
    CHECK((wo - axes.wo).norm() < 1e-12);
  }
  const auto some = gonio::pairs_within(axes, {0.0, radians(10.0)}, 512);
  CHECK(some.size() > 256);
  CHECK(some.size() < 400);
  for (const auto& [wi, wo] : some) CHECK(wo.z() > 0.0);
}
