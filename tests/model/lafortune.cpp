#include "physical.hpp"
#include <gonio/model/lafortune.hpp>

using gonio::direction;
using gonio::rgb;

TEST_CASE("Lafortune's lobe keeps what a BRDF must keep") {
  for (const double tilt : {-1.2, 0.0, 0.5, pi / 4, 1.3}) {
    CAPTURE(tilt);
    const gonio::model::lafortune f({0.1, 0.3, 0.9}, {.tilt = tilt, .exponent = 30.0});
    check_finite_at_special_pairs_and_zero_below_the_horizon(f);
    check_reciprocal_isotropic_and_not_negative(f);
  }
}

TEST_CASE("Lafortune's lobe is the generalised cosine, and its colour the highest reflectance") {
  CHECK(rc::check([] {
    const double tilt = (2.0 * any_fraction() - 1.0) * pi / 2.0, n = 1.0 + 50.0 * any_fraction();
    const direction wi = any_direction(), wo = any_direction();
    RC_PRE(wi.z() > 1e-6 && wo.z() > 1e-6);
    const double within = -std::sin(tilt), along = std::cos(tilt);
    const double product = within * (wi.x() * wo.x() + wi.y() * wo.y()) + along * wi.z() * wo.z();
    const double expected = std::pow(std::max(product, 0.0) / std::max(std::abs(within), along), n);
    const double value = gonio::model::lafortune(rgb::Ones(), {.tilt = tilt, .exponent = n})(wi, wo)[0];
    RC_ASSERT(std::abs(value - expected) < 1e-10);
    RC_ASSERT(value <= 1.0 + 1e-12);
  }));
}

TEST_CASE("at 45 degrees it is Phong's lobe; at 0 a diffuse one; below, it reflects back to the light") {
  const direction wi = gonio::spherical_direction(0.6, 0.3), wo = gonio::spherical_direction(0.5, 3.2);
  const double s = 12.0;
  CHECK(gonio::model::lafortune(rgb::Ones(), {.tilt = pi / 4, .exponent = s})(wi, wo)[0] ==
        doctest::Approx(gonio::model::phong(rgb::Ones(), {.shininess = s})(wi, wo)[0] * 2.0 * pi / (s + 2.0)));
  CHECK(gonio::model::lafortune(rgb::Ones(), {.tilt = 0.0, .exponent = 2.0})(wi, wo)[0] ==
        doctest::Approx(std::pow(wi.z() * wo.z(), 2.0)));
  const gonio::model::lafortune back(rgb::Ones(), {.tilt = -pi / 4, .exponent = s});
  CHECK(back(wi, wi)[0] > 10.0 * back(wi, wo)[0]);
}
