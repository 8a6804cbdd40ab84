#include "physical.hpp"
#include <gonio/model/lambert.hpp>

using gonio::rgb;
using gonio::model::lambertian;

TEST_CASE("a Lambertian surface keeps what a BRDF must keep") {
  const lambertian f{.albedo = {0.2, 0.5, 0.9}};
  check_reciprocal_isotropic_and_not_negative(f);
  check_finite_at_special_pairs_and_zero_below_the_horizon(f);
}

TEST_CASE("a Lambertian surface reflects its albedo from every angle, as the same radiance in every direction") {
  const lambertian f{.albedo = {0.2, 0.5, 0.9}};
  for (const double theta : {0.0, 0.6, 1.2}) {
    CAPTURE(theta);
    // The quadrature's cut at the horizon loses about one bin in 400.
    CHECK(((albedo(f, theta) - f.albedo).abs() < 2e-3).all());
  }
  CHECK(rc::check([&] {
    const gonio::direction wi = any_direction(), wo = any_direction();
    RC_PRE(wi.z() > 0.0 && wo.z() > 0.0);
    RC_ASSERT(((f(wi, wo) * pi - f.albedo).abs() < 1e-15).all());
  }));
}

TEST_CASE("a Lambertian surface is white unless told otherwise") {
  const gonio::direction normal(0.0, 0.0, 1.0);
  CHECK(lambertian()(normal, normal).x() == doctest::Approx(1.0 / pi));
}
