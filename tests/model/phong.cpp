#include "physical.hpp"
#include <gonio/model/phong.hpp>

using gonio::direction;
using gonio::rgb;

TEST_CASE("the Phong lobes keep what a BRDF must keep") {
  for (const double s : {0.5, 20.0, 3000.0}) {
    CAPTURE(s);
    const gonio::model::phong phong(rgb::Constant(0.3), {.shininess = s});
    const gonio::model::blinn_phong blinn(rgb::Constant(0.3), {.shininess = s});
    const gonio::model::phong_blinn between(rgb::Constant(0.3), {.shininess = s, .alpha = 0.4});
    const auto check = [&](const auto& f) {
      check_finite_at_special_pairs_and_zero_below_the_horizon(f);
      check_reciprocal_isotropic_and_not_negative(f);
    };
    check(phong);
    check(blinn);
    check(between);
  }
}

TEST_CASE("Phong, Blinn-Phong and the variant between are the paper's formulas") {
  CHECK(rc::check([] {
    const double s = std::pow(10.0, 4.0 * any_fraction() - 1.0), alpha = any_fraction();
    const direction wi = any_direction(), wo = any_direction();
    RC_PRE(wi.z() > 1e-6 && wo.z() > 1e-6);
    const direction mirrored = 2.0 * wi.z() * direction(0.0, 0.0, 1.0) - wi, h = (wi + wo).normalized();
    const double cosine = std::max(mirrored.dot(wo), 0.0);
    const auto near = [&](double value, double expected) {
      return std::abs(value - expected) <= 1e-9 * s * expected + 1e-12;
    };
    const rgb colour(0.2, 0.4, 0.8);
    RC_ASSERT(near(gonio::model::phong(colour, {.shininess = s})(wi, wo)[1],
                   0.4 * (s + 2.0) / (2.0 * pi) * std::pow(cosine, s)));
    RC_ASSERT(near(gonio::model::blinn_phong(colour, {.shininess = s})(wi, wo)[1],
                   0.4 * (s + 8.0) / (8.0 * pi) * std::pow(h.z(), s)));
    const double base = (1.0 - alpha) * mirrored.dot(wo) + alpha * std::pow(h.z(), 4.0);
    RC_ASSERT(near(gonio::model::phong_blinn(colour, {.shininess = s, .alpha = alpha})(wi, wo)[1],
                   0.4 * std::pow(std::max(base, 0.0), s)));
  }));
}

TEST_CASE("the variant's ends are Phong and Blinn-Phong of four times the exponent, without their normalisations") {
  CHECK(rc::check([] {
    const direction wi = any_direction(), wo = any_direction();
    RC_PRE(wi.z() > 1e-6 && wo.z() > 1e-6);
    const double s = 30.0;
    const rgb white = rgb::Ones();
    const double phong = gonio::model::phong(white, {.shininess = s})(wi, wo)[0] * 2.0 * pi / (s + 2.0);
    const double blinn =
        gonio::model::blinn_phong(white, {.shininess = 4.0 * s})(wi, wo)[0] * 8.0 * pi / (4.0 * s + 8.0);
    RC_ASSERT(std::abs(gonio::model::phong_blinn(white, {.shininess = s, .alpha = 0.0})(wi, wo)[0] - phong) < 1e-10);
    RC_ASSERT(std::abs(gonio::model::phong_blinn(white, {.shininess = s, .alpha = 1.0})(wi, wo)[0] - blinn) < 1e-10);
  }));
}

TEST_CASE("modified Phong of a narrow lobe reflects its colour from above, and less at grazing angles") {
  const gonio::model::phong f(rgb::Constant(0.5), {.shininess = 200.0});
  CHECK(albedo(f, 0.0)[0] == doctest::Approx(0.5).epsilon(5e-3));
  CHECK(albedo(f, 1.45)[0] < 0.2);
}

TEST_CASE("Blinn-Phong's (s + 8) / (8 pi) is an approximation: up to 8 % more than its colour is reflected") {
  double largest = 0.0;
  for (const double s : {1.0, 10.0, 100.0, 1000.0})
    for (const double theta : {0.0, 0.3, 0.7, 1.3})
      largest = std::max(largest, albedo(gonio::model::blinn_phong(rgb::Ones(), {.shininess = s}), theta)[0]);
  CHECK(largest > 1.05);
  CHECK(largest < 1.08);
}
