#include "physical.hpp"
#include <gonio/model/analytic_brdf.hpp>

using gonio::direction;
using gonio::rgb;
using gonio::model::anisotropic_ggx;
using gonio::model::anisotropic_ggx_shape;

namespace {

using shape = anisotropic_ggx_shape<double>;

/// D and G1 as Heitz 2014 prints them, with tangents, in the axes of the shape.
double as_printed(const shape& f, const direction& wi, const direction& wo) {
  const auto own = [&](const direction& w) { return gonio::turned_about_normal(w, -f.rotation); };
  const direction h = own((wi + wo).normalized());
  const double slopes = std::pow(h.x() / h.z() / f.alpha_x, 2.0) + std::pow(h.y() / h.z() / f.alpha_y, 2.0);
  const double D = 1.0 / (pi * f.alpha_x * f.alpha_y * std::pow(h.z(), 4.0) * std::pow(1.0 + slopes, 2.0));
  const auto G1 = [&](const direction& w) {
    const direction v = own(w);
    const double squared = (std::pow(f.alpha_x * v.x(), 2.0) + std::pow(f.alpha_y * v.y(), 2.0)) / (v.z() * v.z());
    return 2.0 / (1.0 + std::sqrt(1.0 + squared));
  };
  const double F = f.f0 + (1.0 - f.f0) * std::pow(1.0 - own(wi).dot(h), 5.0);
  return F * D * G1(wi) * G1(wo) / (4.0 * wi.z() * wo.z());
}

}  // namespace

TEST_CASE("anisotropic GGX is the paper's formula in rotated axes") {
  CHECK(rc::check([] {
    const shape f{.alpha_x = 0.02 + 0.9 * any_fraction(),
                  .alpha_y = 0.02 + 0.9 * any_fraction(),
                  .f0 = any_fraction(),
                  .rotation = 3.0 * (any_fraction() - 0.5)};
    const direction wi = any_direction(), wo = any_direction();
    RC_PRE(wi.z() > 1e-3 && wo.z() > 1e-3);
    const double expected = as_printed(f, wi, wo);
    RC_ASSERT(std::abs(anisotropic_ggx(rgb::Ones(), f)(wi, wo).x() - expected) <= 1e-8 * expected);
  }));
}

TEST_CASE("anisotropic GGX with equal alphas is GGX, and keeps what a BRDF must keep") {
  const gonio::model::ggx same{.alpha = 0.3, .f0 = rgb::Constant(0.1)};
  const anisotropic_ggx f(rgb::Ones(), {.alpha_x = 0.3, .alpha_y = 0.3, .f0 = 0.1, .rotation = 0.4});
  check_reciprocal_isotropic_and_not_negative(f);
  CHECK(rc::check([&] {
    const direction wi = any_direction(), wo = any_direction();
    RC_ASSERT(std::abs(f(wi, wo).y() - same(wi, wo).y()) <= 1e-10 * same(wi, wo).y());
  }));
  for (const double rotation : {0.0, 0.7}) {
    const anisotropic_ggx brushed(rgb(0.1, 0.5, 1.0),
                                  {.alpha_x = 0.02, .alpha_y = 0.5, .f0 = 0.9, .rotation = rotation});
    check_finite_at_special_pairs_and_zero_below_the_horizon(brushed);
    const direction wi = gonio::spherical_direction(0.5, 0.3), wo = gonio::spherical_direction(0.9, 2.6);
    CHECK((brushed(wi, wo) == brushed(wo, wi)).all());
    const auto turned = [&](const direction& w) { return gonio::turned_about_normal(w, rotation); };
    const anisotropic_ggx unrotated(rgb(0.1, 0.5, 1.0), {.alpha_x = 0.02, .alpha_y = 0.5, .f0 = 0.9});
    CHECK((brushed(turned(wi), turned(wo)) / unrotated(wi, wo) - 1.0).abs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("anisotropic GGX: golden values, and a highlight that is narrow along x and wide along y") {
  const anisotropic_ggx f(rgb::Ones(), {.alpha_x = 0.1, .alpha_y = 0.4, .f0 = 1.0});
  const direction up(0.0, 0.0, 1.0), along_x = gonio::spherical_direction(0.4, 0.0),
                                     along_y = gonio::spherical_direction(0.4, pi / 2);
  CHECK(f(up, up).x() == doctest::Approx(1.0 / (4.0 * pi * 0.04)).epsilon(1e-12));
  // With tan(0.2) = 0.2027100355: D = 1 / (pi 0.04 (1 + (tan / alpha)^2)^2 cos^4), and G1 over 2 cos of Heitz.
  CHECK(f(up, along_x).x() == doctest::Approx(as_printed(f.shape(), up, along_x)).epsilon(1e-12));
  CHECK(f(up, along_y).x() > 5.0 * f(up, along_x).x());
  CHECK(gonio::model::worst_anisotropy(f).amount > 0.9);
}

TEST_CASE("anisotropic kinds are found by name, are apart from the isotropic ones, and say what they are") {
  for (const gonio::model::lobe_kind* kind : gonio::model::anisotropic_lobe_kinds()) {
    CAPTURE(kind->name());
    CHECK(kind->is_anisotropic());
    CHECK(gonio::model::lobe_kind_named(kind->name()) == *kind);
    CHECK(std::ranges::count(gonio::model::lobe_kinds(), kind) == 0);
    const gonio::model::analytic_brdf f({gonio::model::analytic_lobe(*kind, {0.1, 0.2, 0.9}, kind->typical())});
    CHECK(f.is_anisotropic());
    check_finite_at_special_pairs_and_zero_below_the_horizon(f);
    CHECK(gonio::model::worst_anisotropy(f).amount > 0.5);
    CHECK(gonio::model::worst_asymmetry(f).amount < 1e-9);
  }
  for (const gonio::model::lobe_kind* kind : gonio::model::lobe_kinds()) CHECK(!kind->is_anisotropic());
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::model::lobe_kind_named("brushed")),
                       doctest::Contains("ggx-anisotropic"), gonio::error);
  using gonio::model::analytic_lobe;
  const auto& kind = gonio::model::lobe_kind::of<anisotropic_ggx_shape>();
  CHECK_THROWS_WITH_AS(static_cast<void>(analytic_lobe(kind, rgb::Ones(), {0.1, 0.2, 0.1, 2.0})),
                       doctest::Contains("ggx-anisotropic: rotation must be from -1.570796"), gonio::error);
}
