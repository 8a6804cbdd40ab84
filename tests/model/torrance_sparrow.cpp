#include "physical.hpp"
#include <gonio/model/torrance_sparrow.hpp>

using gonio::direction;
using gonio::rgb;

namespace {

/// Thesis, Eq. 2.19 to 2.22, in angles; the Fresnel factor uses theta_d.
double as_printed(double m, double f0, const direction& wi, const direction& wo) {
  const direction h = (wi + wo).normalized();
  const double theta_h = std::acos(std::min(h.z(), 1.0)), cosine_d = wi.dot(h);
  const double D = std::exp(-std::pow(std::tan(theta_h) / m, 2.0)) / (pi * m * m * std::pow(std::cos(theta_h), 4.0));
  const double F = f0 + (1.0 - f0) * std::pow(1.0 - cosine_d, 5.0);
  const double G = std::min({1.0, 2.0 * h.z() * wi.z() / cosine_d, 2.0 * h.z() * wo.z() / cosine_d});
  return D * F * G / (4.0 * wi.z() * wo.z());
}

}  // namespace

TEST_CASE("Torrance and Sparrow's model keeps what a BRDF must keep") {
  for (const double slope : {0.05, 0.3, 1.5}) {
    CAPTURE(slope);
    const gonio::model::torrance_sparrow f({0.1, 0.4, 1.0}, {.slope = slope, .f0 = 0.3});
    check_finite_at_special_pairs_and_zero_below_the_horizon(f);
    check_reciprocal_isotropic_and_not_negative(f);
  }
}

TEST_CASE("Torrance and Sparrow's model is the thesis's formula") {
  CHECK(rc::check([] {
    const double m = 0.1 + any_fraction(), f0 = any_fraction();
    const direction wi = any_direction(), wo = any_direction();
    RC_PRE(wi.z() > 1e-3 && wo.z() > 1e-3);
    const double expected = as_printed(m, f0, wi, wo);
    RC_ASSERT(std::abs(gonio::model::torrance_sparrow(rgb::Ones(), {.slope = m, .f0 = f0})(wi, wo)[0] - expected) <=
              1e-7 * expected + 1e-200);
  }));
}

TEST_CASE("Beckmann's distribution with the cosine integrates to 1") {
  for (const double m : {0.1, 0.4, 1.0}) {
    CAPTURE(m);
    const gonio::model::torrance_sparrow_shape<double> shape{.slope = m};
    const int bins = 20000;
    double sum = 0.0;
    for (int i = 0; i < bins; ++i) {
      const double theta = (i + 0.5) / bins * pi / 2.0;
      sum += shape.distribution(std::pow(std::tan(theta), 2.0)) * std::cos(theta) * std::sin(theta) * 2.0 * pi * pi /
             2.0 / bins;
    }
    CHECK(sum == doctest::Approx(1.0).epsilon(1e-5));
  }
}

TEST_CASE("it never reflects more than it receives") {
  for (const double m : {0.1, 0.4, 1.0})
    for (const double theta : {0.0, 0.7, 1.2, 1.5}) {
      CAPTURE(m);
      CAPTURE(theta);
      CHECK(albedo(gonio::model::torrance_sparrow(rgb::Ones(), {.slope = m, .f0 = 1.0}), theta)[0] <= 1.0 + 2e-3);
    }
}
