#include "physical.hpp"
#include <gonio/model/ward.hpp>

using gonio::direction;
using gonio::rgb;

namespace {

const direction normal(0.0, 0.0, 1.0);

/// exp(-tan^2 theta_h (cos^2 phi / ax^2 + sin^2 phi / ay^2)) / (4 pi ax ay), computed from angles.
double printed_gaussian(const direction& wi, const direction& wo, double ax, double ay) {
  const direction h = (wi + wo).normalized();
  const double theta = std::acos(std::min(h.z(), 1.0)), phi = std::atan2(h.y(), h.x());
  const double spread = std::pow(std::cos(phi) / ax, 2.0) + std::pow(std::sin(phi) / ay, 2.0);
  return std::exp(-std::pow(std::tan(theta), 2.0) * spread) / (4.0 * pi * ax * ay);
}

}  // namespace

TEST_CASE("Ward's lobes keep what a BRDF must keep") {
  for (const double roughness : {0.05, 0.3, 1.5}) {
    CAPTURE(roughness);
    const rgb colour(0.1, 0.4, 1.0);
    const auto check = [](const auto& f) {
      check_finite_at_special_pairs_and_zero_below_the_horizon(f);
      check_reciprocal_isotropic_and_not_negative(f);
    };
    check(gonio::model::ward(colour, {.roughness = roughness}));
    check(gonio::model::ward_bounded(colour, {.roughness = roughness}));
    check_finite_at_special_pairs_and_zero_below_the_horizon(gonio::model::ward_duer(colour, {.roughness = roughness}));
    check_finite_at_special_pairs_and_zero_below_the_horizon(
        gonio::model::anisotropic_ward_duer(colour, {.roughness_x = roughness, .roughness_y = 0.1}));
  }
}

TEST_CASE("Ward's lobes are their papers' formulas, which differ by the cosines alone") {
  CHECK(rc::check([] {
    const double ax = 0.1 + any_fraction(), ay = 0.1 + any_fraction();
    const direction wi = any_direction(), wo = any_direction();
    RC_PRE(wi.z() > 1e-3 && wo.z() > 1e-3);
    const double gaussian = printed_gaussian(wi, wo, ax, ay), cosines = wi.z() * wo.z();
    const direction u = wi + wo;
    const auto near = [](double value, double expected) {
      return std::abs(value - expected) <= 1e-8 * expected + 1e-200;
    };
    const rgb white = rgb::Ones();
    RC_ASSERT(near(gonio::model::anisotropic_ward(white, {.roughness_x = ax, .roughness_y = ay})(wi, wo)[0],
                   gaussian / std::sqrt(cosines)));
    RC_ASSERT(near(gonio::model::anisotropic_ward_duer(white, {.roughness_x = ax, .roughness_y = ay})(wi, wo)[0],
                   gaussian / cosines));
    RC_ASSERT(near(gonio::model::anisotropic_ward_bounded(white, {.roughness_x = ax, .roughness_y = ay})(wi, wo)[0],
                   gaussian * 4.0 * u.squaredNorm() / std::pow(u.z(), 4.0)));
    const auto same = [&](const auto& isotropic, const auto& anisotropic) {
      return near(isotropic(wi, wo)[0], anisotropic(wi, wo)[0]);
    };
    RC_ASSERT(same(gonio::model::ward(white, {.roughness = ax}),
                   gonio::model::anisotropic_ward(white, {.roughness_x = ax, .roughness_y = ax})));
    RC_ASSERT(same(gonio::model::ward_duer(white, {.roughness = ax}),
                   gonio::model::anisotropic_ward_duer(white, {.roughness_x = ax, .roughness_y = ax})));
    RC_ASSERT(same(gonio::model::ward_bounded(white, {.roughness = ax}),
                   gonio::model::anisotropic_ward_bounded(white, {.roughness_x = ax, .roughness_y = ax})));
  }));
}

TEST_CASE("from above all three are the same, and reflect their colour if they are smooth") {
  const rgb colour(0.2, 0.4, 0.8);
  const gonio::model::ward classic(colour, {.roughness = 0.1});
  const gonio::model::ward_duer product(colour, {.roughness = 0.1});
  const gonio::model::ward_bounded bounded(colour, {.roughness = 0.1});
  CHECK(classic(normal, normal)[1] == doctest::Approx(0.4 / (4.0 * pi * 0.01)));
  CHECK(product(normal, normal)[1] == doctest::Approx(classic(normal, normal)[1]));
  CHECK(bounded(normal, normal)[1] == doctest::Approx(classic(normal, normal)[1]));
  CHECK(albedo(bounded, 0.0)[2] == doctest::Approx(0.8).epsilon(1e-2));
}

TEST_CASE("at grazing angles Ward's albedo falls, Duer's grows beyond 1, the bounded one does neither") {
  const rgb white = rgb::Ones();
  const double grazing = gonio::radians(88.0);
  CHECK(albedo(gonio::model::ward(white, {.roughness = 0.2}), grazing)[0] < 0.7);
  CHECK(albedo(gonio::model::ward_duer(white, {.roughness = 0.2}), grazing)[0] > 1.2);
  for (const double theta : {0.0, 0.5, 1.0, 1.3, grazing}) {
    CAPTURE(theta);
    CHECK(albedo(gonio::model::ward_bounded(white, {.roughness = 0.2}), theta)[0] <= 1.0 + 2e-3);
  }
}
