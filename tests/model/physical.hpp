#pragma once
/// Checks of the physical properties of any analytic BRDF.

#include <gonio/core/brdf.hpp>
#include <gonio/model/physical_properties.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <numbers>

inline constexpr double pi = std::numbers::pi;

/// Returns an integer of [0, 10^6] as a fraction. All are equally likely from the first example on.
inline double any_fraction() { return 1e-6 * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 1'000'001)); }

/// Returns a direction above the horizon, including grazing ones.
inline gonio::direction any_direction() {
  const double theta = any_fraction() * pi / 2.0;
  return gonio::spherical_direction(theta, any_fraction() * 2.0 * pi);
}

template <gonio::brdf Brdf>
void check_reciprocal_isotropic_and_not_negative(const Brdf& f) {
  CHECK(rc::check([&] {
    const gonio::direction wi = any_direction(), wo = any_direction();
    const gonio::rgb value = f(wi, wo);
    RC_ASSERT((value >= 0.0).all());
    RC_ASSERT(value.isFinite().all());
    // wi + wo and products of two factors do not depend on their order: equality is exact.
    RC_ASSERT((f(wo, wi) == value).all());
    const double turn = any_fraction() * 2.0 * pi;
    const auto turned = [turn](const gonio::direction& w) { return gonio::turned_about_normal(w, turn); };
    // A rotation has a rounding error of 1e-16, which a highlight of width alpha amplifies by about 1/alpha.
    RC_ASSERT(((f(turned(wi), turned(wo)) - value).abs() <= 1e-9 * value.maxCoeff() + 1e-12).all());
  }));
}

template <gonio::brdf Brdf>
void check_finite_at_special_pairs_and_zero_below_the_horizon(const Brdf& f) {
  const auto at = [](double theta, double phi) { return gonio::spherical_direction(theta, phi); };
  const gonio::direction normal(0.0, 0.0, 1.0);
  const double least = 1e-300;
  const gonio::direction_pair above[] = {
      {normal, normal},
      {at(0.7, 0.0), at(0.7, pi)},
      {at(pi / 2 - 1e-9, 0.0), at(pi / 2 - 1e-9, pi)},
      {at(pi / 2 - 1e-9, 0.0), at(pi / 2 - 1e-9, 0.0)},
      {at(pi / 2 - 1e-9, 0.0), normal},
      {{1.0, 0.0, least}, {-1.0, 0.0, least}},
      {{1.0, 0.0, least}, {0.0, 1.0, least}},
      {{1.0, 0.0, 1e-170}, {-1.0, 0.0, 1e-170}},
  };
  for (const auto& [wi, wo] : above) {
    CAPTURE(wi.transpose());
    CAPTURE(wo.transpose());
    CHECK(f(wi, wo).isFinite().all());
    CHECK((f(wi, wo) >= 0.0).all());
  }
  const gonio::direction below[] = {{1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, at(2.0, 1.0), {0.0, 1.0, -least}};
  for (const gonio::direction& w : below) {
    CAPTURE(w.transpose());
    CHECK((f(w, normal) == 0.0).all());
    CHECK((f(normal, w) == 0.0).all());
    CHECK((f(w, w) == 0.0).all());
  }
}

/// Returns the fraction of light from angle theta that is reflected.
template <gonio::brdf Brdf>
gonio::rgb albedo(const Brdf& f, double theta, int bins = 400) {
  return gonio::model::directional_albedo(f, theta, bins);
}
