#include "physical.hpp"
#include <gonio/model/fresnel_lobe.hpp>

TEST_CASE("a lobe with Fresnel's factor is the lobe times it") {
  const gonio::model::phong_blinn_fresnel f({0.2, 0.4, 0.8},
                                            {.lobe = {.shininess = 20.0, .alpha = 0.3}, .refractive_index = 1.6});
  check_finite_at_special_pairs_and_zero_below_the_horizon(f);
  check_reciprocal_isotropic_and_not_negative(f);
  const gonio::model::phong_blinn without({0.2, 0.4, 0.8}, {.shininess = 20.0, .alpha = 0.3});
  const gonio::direction wi = gonio::spherical_direction(0.9, 0.1), wo = gonio::spherical_direction(0.7, 2.9);
  const double cosine = wi.dot((wi + wo).normalized());
  CHECK(f(wi, wo)[1] == doctest::Approx(without(wi, wo)[1] * gonio::fresnel_dielectric(cosine, 1.6)));
}

TEST_CASE("its name and parameters are those of the lobe, and the refractive index") {
  using shape = gonio::model::with_fresnel<gonio::model::phong_blinn_shape>::shape<double>;
  CHECK(shape::name == "phong-blinn-fresnel");
  REQUIRE(shape::parameters.size() == 3);
  CHECK(shape::parameters[0].name == "shininess");
  CHECK(shape::parameters[2].name == "refractive_index");
  CHECK_THROWS_WITH_AS(gonio::model::phong_fresnel(gonio::rgb::Ones(), {.lobe = {}, .refractive_index = 0.9}),
                       doctest::Contains("refractive_index must be from 1.01"), gonio::error);
}
