#include "physical.hpp"
#include <gonio/model/formula_materials.hpp>

using gonio::rgb;
using gonio::model::formula_material;
using gonio::model::formula_material_names;

TEST_CASE("every material by formula keeps what a BRDF must keep, and its albedo is below 1") {
  REQUIRE(formula_material_names().size() >= 4);
  for (const std::string& name : formula_material_names()) {
    CAPTURE(name);
    const gonio::model::formula_brdf f = formula_material(name);
    check_reciprocal_isotropic_and_not_negative(f);
    check_finite_at_special_pairs_and_zero_below_the_horizon(f);
    for (const double degrees : {0.0, 30.0, 60.0, 75.0, 85.0, 88.0}) {
      CAPTURE(degrees);
      CHECK(albedo(f, gonio::radians(degrees), 200).maxCoeff() < 1.0);
    }
  }
}

TEST_CASE("the names describe the materials") {
  const gonio::direction normal(0.0, 0.0, 1.0), oblique = gonio::spherical_direction(0.8, 0.0);
  const auto off_highlight = [&](const char* name) { return formula_material(name)(normal, oblique); };
  const rgb red = off_highlight("red-paint"), blue = off_highlight("blue-rubber"), gold = off_highlight("gold-metal");
  CHECK(red.x() > 5.0 * red.y());
  CHECK(red.x() > 5.0 * red.z());
  CHECK(blue.z() > 2.0 * blue.x());
  CHECK(gold.x() > 1.2 * gold.y());
  CHECK(gold.y() > 1.2 * gold.z());

  const auto highlight = [&](const char* name) { return formula_material(name)(normal, normal).x(); };
  CHECK(highlight("red-paint") > 2.0 * red.x());
  CHECK(highlight("blue-rubber") < 2.0 * blue.x());
  const rgb grey = off_highlight("grey-lambertian");
  CHECK((grey == 0.18 * std::numbers::inv_pi).all());
  CHECK((formula_material("grey-lambertian")(oblique, oblique) == grey).all());
}

TEST_CASE("the paint of the demonstration has the published parameters") {
  using paint = gonio::model::sum_of_lobes<gonio::model::lambertian, gonio::model::ggx>;
  const gonio::model::formula_brdf f = formula_material("red-paint");
  const paint* parameters = std::get_if<paint>(&f.formula());
  REQUIRE(parameters != nullptr);
  CHECK(std::get<1>(parameters->lobes()).alpha == 0.15);
  CHECK((std::get<1>(parameters->lobes()).f0 == 0.04).all());
}

TEST_CASE("an unknown material is refused with the names that exist") {
  CHECK_THROWS_AS((void)formula_material(""), gonio::error);
  CHECK_THROWS_WITH_AS((void)formula_material("unobtainium"), doctest::Contains("'unobtainium'"), gonio::error);
  for (const std::string& name : formula_material_names())
    CHECK_THROWS_WITH_AS((void)formula_material("unobtainium"), doctest::Contains(name.c_str()), gonio::error);
}
