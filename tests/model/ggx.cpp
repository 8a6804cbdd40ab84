#include "physical.hpp"
#include <gonio/model/ggx.hpp>

using gonio::direction;
using gonio::rgb;
using gonio::model::ggx;

namespace {

const direction normal(0.0, 0.0, 1.0);

/// Eq. 20, 23, 33 and 34 with tangents and the fraction as printed.
double as_printed(const ggx& f, const direction& wi, const direction& wo) {
  const direction h = (wi + wo).normalized();
  const auto squared_tangent = [](const direction& v) { return (1.0 - v.z() * v.z()) / (v.z() * v.z()); };
  const double a2 = f.alpha * f.alpha, cos4 = std::pow(h.z(), 4.0);
  const double D = a2 / (pi * cos4 * std::pow(a2 + squared_tangent(h), 2.0));
  const auto G1 = [&](const direction& v) { return 2.0 / (1.0 + std::sqrt(1.0 + a2 * squared_tangent(v))); };
  const double F = f.f0.x() + (1.0 - f.f0.x()) * std::pow(1.0 - wi.dot(h), 5.0);
  return F * D * G1(wi) * G1(wo) / (4.0 * wi.z() * wo.z());
}

/// Midpoint sum of D(h) * weight(h) over the hemisphere, with narrower rings where D is large.
template <class Weight>
double integrate_distribution(const ggx& f, int bins, Weight&& weight) {
  double sum = 0.0;
  for (int i = 0; i < bins; ++i) {
    const auto edge = [bins](double s) { return std::pow(s / bins, 2.0) * pi / 2.0; };
    const double theta = edge(i + 0.5), ring = std::cos(edge(i)) - std::cos(edge(i + 1.0));
    for (int k = 0; k < bins; ++k) {
      const direction h = gonio::spherical_direction(theta, (k + 0.5) * 2.0 * pi / bins);
      sum += f.distribution(h) * weight(h) * ring * 2.0 * pi / bins;
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("GGX keeps what a BRDF must keep, from mirror-like to rough") {
  for (const double alpha : {1e-3, 0.05, 0.3, 1.0}) {
    CAPTURE(alpha);
    const ggx f{.alpha = alpha, .f0 = {0.02, 0.5, 1.0}};
    check_finite_at_special_pairs_and_zero_below_the_horizon(f);
    // Rounding of h is amplified by 1/alpha, so a tolerance of 1e-9 on isotropy is meaningless for alpha = 1e-3.
    if (alpha > 0.01) check_reciprocal_isotropic_and_not_negative(f);
  }
}

TEST_CASE("GGX is the paper's formula") {
  CHECK(rc::check([] {
    const ggx f{.alpha = 0.02 + 0.98 * any_fraction(), .f0 = rgb::Constant(any_fraction())};
    const direction wi = any_direction(), wo = any_direction();
    // Tangents lose their digits near grazing; there the printed form is the less accurate one.
    RC_PRE(wi.z() > 1e-3 && wo.z() > 1e-3);
    RC_ASSERT(std::abs(f(wi, wo).x() - as_printed(f, wi, wo)) <= 1e-9 * as_printed(f, wi, wo));
  }));
}

TEST_CASE("at normal incidence GGX is f0 / (4 pi alpha^2), and its Fresnel factor runs from f0 to 1") {
  const ggx f{.alpha = 0.15, .f0 = {0.04, 0.5, 1.0}};
  const rgb peak = f(normal, normal);
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    CHECK(peak[channel] == doctest::Approx(f.f0[channel] / (4.0 * pi * 0.15 * 0.15)).epsilon(1e-14));
    CHECK(f.fresnel(1.0)[channel] == f.f0[channel]);
    CHECK(f.fresnel(0.0)[channel] == 1.0);
  }
  CHECK(f.masking(1.0) == doctest::Approx(1.0).epsilon(1e-15));
  CHECK(f.masking(1e-9) < 1e-7);
}

TEST_CASE("GGX without reflectance at normal incidence is not negative where the cosine rounds to more than 1") {
  const ggx f{.alpha = 0.3, .f0 = rgb::Zero()};
  for (int i = 0; i < 1000; ++i) {
    const direction w = gonio::spherical_direction(0.0015 * i, 0.7 * i);
    CHECK((f(w, w) >= 0.0).all());
  }
}

TEST_CASE("GGX's distribution with the cosine integrates to 1") {
  for (const double alpha : {0.05, 0.15, 0.5, 1.0}) {
    CAPTURE(alpha);
    const double integral = integrate_distribution(ggx{.alpha = alpha}, 400, [](const direction& h) { return h.z(); });
    CHECK(integral == doctest::Approx(1.0).epsilon(2e-4));  // 400 rings: at most 8e-5
  }
}

TEST_CASE("the microfacets that are visible cover the surface exactly: G1 is Smith's for this distribution") {
  // The integral of G1(v) max(v.h, 0) D(h) is cos theta_v. Given Eq. 33, this determines Eq. 34.
  for (const double alpha : {0.1, 0.4, 1.0})
    for (const double theta : {0.0, 0.5, 1.0, 1.4}) {
      CAPTURE(alpha);
      CAPTURE(theta);
      const ggx f{.alpha = alpha};
      const direction v = gonio::spherical_direction(theta, 0.0);
      const double visible =
          integrate_distribution(f, 400, [&](const direction& h) { return std::max(v.dot(h), 0.0); }) *
          f.masking(v.z());
      CHECK(visible == doctest::Approx(v.z()).epsilon(1e-4));
    }
}

TEST_CASE("GGX never reflects more than it receives, and nearly everything when smooth") {
  for (const double alpha : {0.05, 0.15, 0.5, 1.0})
    for (const double theta : {0.0, 0.4, 0.8, 1.2, 1.5}) {
      CAPTURE(alpha);
      CAPTURE(theta);
      const double reflected = albedo(ggx{.alpha = alpha, .f0 = rgb::Ones()}, theta).x();
      CHECK(reflected <= 1.0 + 1e-3);  // the error of the quadrature
      if (alpha == 0.05 && theta < 1.0) CHECK(reflected > 0.98);
      if (alpha == 1.0) CHECK(reflected < 0.8);  // the model has single scattering only
    }
}
