#include "../sampler_checks.hpp"
#include <gonio/model/ggx.hpp>
#include <gonio/render/anisotropic_sampler.hpp>

#include <doctest/doctest.h>

using gonio::direction;
using gonio::rgb;
using gonio::model::anisotropic_ggx;
using gonio::render::anisotropic_sampler;

static_assert(gonio::direction_sampler<anisotropic_sampler<anisotropic_ggx>>);

TEST_CASE("an anisotropic BRDF is drawn with the density that is told, and its albedo is right at each azimuth") {
  const anisotropic_ggx f(rgb::Ones(), {.alpha_x = 0.1, .alpha_y = 0.4, .f0 = 0.9, .rotation = 0.3});
  const anisotropic_sampler sampler(f);
  for (const double theta : {0.0, 40.0, 75.0})
    for (const double azimuth : {0.0, 1.1}) {
      CAPTURE(theta);
      CAPTURE(azimuth);
      const direction wo = gonio::spherical_direction(gonio::radians(theta), azimuth);
      const auto sampled = sampler_checks::albedo_by_sampling(sampler, wo, 20'000, 1);
      CHECK(std::abs(sampled.mean - sampler_checks::albedo_by_quadrature(f, wo)) < 4.0 * sampled.standard_error);
      CHECK(sampled.variance < 2.0);
      const auto drawn = sampler.sample(wo, 0.3, 0.4);
      CHECK(drawn.pdf == sampler.pdf(drawn.wi, wo));
    }
  CHECK((sampler.sample(direction(0.6, 0.0, -0.8), 0.3, 0.3).weight == 0.0).all());
  CHECK(sampler.pdf(direction::UnitZ(), direction(0.6, 0.0, -0.8)) == 0.0);
}

TEST_CASE("the mean over azimuths is isotropic") {
  const gonio::render::azimuthal_mean mean(anisotropic_ggx(rgb::Ones(), {.alpha_x = 0.2, .alpha_y = 0.4}));
  const direction wi = gonio::spherical_direction(0.6, 0.2), wo = gonio::spherical_direction(0.5, 3.0);
  const auto turned = [](const direction& w) { return gonio::turned_about_normal(w, 0.77); };
  CHECK((mean(turned(wi), turned(wo)) / mean(wi, wo) - 1.0).abs().maxCoeff() < 0.02);
  CHECK((mean(wi, direction(0.6, 0.0, -0.8)) == 0.0).all());
}
