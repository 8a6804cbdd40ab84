#include "../golden.hpp"
#include <gonio/core/direction.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <numbers>

using gonio::direction;
using gonio::half_difference;

namespace {

constexpr double pi = std::numbers::pi;

/// Returns the distance between two azimuths of period pi.
double azimuth_distance(double a, double b) {
  const double apart = std::abs(a - b);
  return std::min(apart, pi - apart);
}

direction any_direction() {
  const double theta = *rc::gen::map(rc::gen::inRange(0, 1'000'000), [](int i) { return i * 1e-6 * pi / 2; });
  const double phi = *rc::gen::map(rc::gen::inRange(0, 1'000'000), [](int i) { return i * 2e-6 * pi; });
  return gonio::spherical_direction(theta, phi);
}

}  // namespace

TEST_CASE("half and difference angles agree with the reference") {
  const auto golden = golden_csv("coords.csv");
  const auto column = [&](const char* name) -> const std::vector<double>& { return golden.at(name); };
  for (std::size_t i = 0; i < column("wix").size(); ++i) {
    CAPTURE(i);
    const direction wi(column("wix")[i], column("wiy")[i], column("wiz")[i]);
    const direction wo(column("wox")[i], column("woy")[i], column("woz")[i]);
    const half_difference angles = gonio::to_half_difference(wi, wo);
    CHECK(angles.theta_h == doctest::Approx(column("theta_h")[i]).epsilon(1e-12).scale(1));
    CHECK(angles.theta_d == doctest::Approx(column("theta_d")[i]).epsilon(1e-12).scale(1));
    // phi_d is undefined at theta_d = 0, and near it as inaccurate as any azimuth near a pole.
    if (column("theta_d")[i] > 1e-9) CHECK(azimuth_distance(angles.phi_d, column("phi_d")[i]) < 1e-9);
    const auto pair = gonio::to_directions({column("theta_h")[i], column("theta_d")[i], column("phi_d")[i]});
    CHECK((pair.wi - direction(column("wi2x")[i], column("wi2y")[i], column("wi2z")[i])).norm() < 1e-14);
    CHECK((pair.wo - direction(column("wo2x")[i], column("wo2y")[i], column("wo2z")[i])).norm() < 1e-14);
    const auto cosine = gonio::cosines({column("theta_h")[i], column("theta_d")[i], column("phi_d")[i]});
    CHECK(cosine.i == doctest::Approx(column("cos_i")[i]).epsilon(1e-14).scale(1));
    CHECK(cosine.o == doctest::Approx(column("cos_o")[i]).epsilon(1e-14).scale(1));
  }
}

TEST_CASE("a pair survives the round trip through its angles, up to rotation and exchange") {
  CHECK(rc::check([] {
    const direction wi = any_direction(), wo = any_direction();
    const auto back = gonio::to_directions(gonio::to_half_difference(wi, wo));
    RC_ASSERT(std::abs(back.wi.norm() - 1.0) < 1e-12);
    RC_ASSERT(std::abs(back.wi.dot(back.wo) - wi.dot(wo)) < 1e-12);
    const bool kept = std::abs(back.wi.z() - wi.z()) < 1e-12 && std::abs(back.wo.z() - wo.z()) < 1e-12;
    const bool exchanged = std::abs(back.wi.z() - wo.z()) < 1e-12 && std::abs(back.wo.z() - wi.z()) < 1e-12;
    RC_ASSERT(kept || exchanged);
  }));
}

TEST_CASE("exchanging the directions changes no angle") {
  CHECK(rc::check([] {
    const direction wi = any_direction(), wo = any_direction();
    const half_difference a = gonio::to_half_difference(wi, wo), b = gonio::to_half_difference(wo, wi);
    RC_ASSERT(std::abs(a.theta_h - b.theta_h) < 1e-14);
    RC_ASSERT(std::abs(a.theta_d - b.theta_d) < 1e-14);
    if (a.theta_d > 1e-6 && a.theta_h > 1e-6) RC_ASSERT(azimuth_distance(a.phi_d, b.phi_d) < 1e-8);
    RC_ASSERT(a.phi_d >= 0.0);
    RC_ASSERT(a.phi_d < pi);
  }));
}

TEST_CASE("special pairs") {
  const direction normal(0, 0, 1);
  SUBCASE("retroreflection along the normal") {
    const auto angles = gonio::to_half_difference(normal, normal);
    CHECK(angles.theta_h == 0.0);
    CHECK(angles.theta_d == 0.0);
    CHECK(angles.phi_d == 0.0);
  }
  SUBCASE("mirror reflection has theta_h 0 and theta_d the angle of incidence, to the last digit, at any angle") {
    for (const double degrees : {1e-6, 0.01, 30.0, 66.0, 89.9, 89.999999}) {
      CAPTURE(degrees);
      const double theta = gonio::radians(degrees);
      const auto angles =
          gonio::to_half_difference(gonio::spherical_direction(theta, 0), gonio::spherical_direction(-theta, 0));
      CHECK(angles.theta_h < 1e-15);
      CHECK(angles.theta_d == doctest::Approx(theta).epsilon(1e-14));
    }
  }
  SUBCASE("tiny half angles keep their digits, where acos of the cosine would give zero") {
    for (const double degrees : {1e-3, 1e-6, 1e-9}) {
      CAPTURE(degrees);
      const double tilt = gonio::radians(degrees), theta = gonio::radians(40);
      const auto angles = gonio::to_half_difference(gonio::spherical_direction(theta + tilt, 0.3),
                                                    gonio::spherical_direction(-theta + tilt, 0.3));
      CHECK(angles.theta_h == doctest::Approx(tilt).epsilon(1e-6));
    }
  }
  SUBCASE("directions below the horizon and opposite directions stay finite") {
    const auto below =
        gonio::to_half_difference(gonio::spherical_direction(2.0, 1.0), gonio::spherical_direction(1.8, 2.0));
    CHECK(below.theta_h > pi / 2);
    CHECK(std::isfinite(below.phi_d));
    const auto opposite = gonio::to_half_difference(direction(1, 0, 0), direction(-1, 0, 0));
    CHECK(opposite.theta_h == 0.0);
    CHECK(opposite.theta_d == doctest::Approx(pi / 2));
    CHECK(std::isfinite(opposite.phi_d));
  }
}

TEST_CASE("phi_d folds into [0, pi)") {
  CHECK(gonio::fold_phi_d(0.0) == 0.0);
  CHECK(gonio::fold_phi_d(pi) == 0.0);
  CHECK(gonio::fold_phi_d(-1e-20) == 0.0);
  CHECK(gonio::fold_phi_d(-0.5) == doctest::Approx(pi - 0.5));
  CHECK(gonio::fold_phi_d(3 * pi + 0.25) == doctest::Approx(0.25));
}

TEST_CASE("a turn about the normal is one of the azimuth") {
  const gonio::direction w = gonio::spherical_direction(0.7, 0.4), turned = gonio::turned_about_normal(w, 1.1);
  CHECK((turned - gonio::spherical_direction(0.7, 1.5)).norm() < 1e-15);
  CHECK(turned.z() == w.z());
}
