#include "physical.hpp"
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/model/ward.hpp>
#include <gonio/table/brdf_table.hpp>

using gonio::direction;
using gonio::rgb;

namespace {

/// Deliberately wrong: brighter where the light is low, negative where it is high, and striped.
struct unphysical {
  rgb operator()(const direction& wi, const direction& /*wo*/) const noexcept {
    return {1.0 / wi.z(), 0.5 - wi.z(), 1.0 + 0.5 * wi.x()};
  }
};

}  // namespace

TEST_CASE("models that keep the rules are found to") {
  const gonio::model::ggx metal{.alpha = 0.2, .f0 = {0.9, 0.7, 0.4}};
  CHECK(gonio::model::worst_asymmetry(metal).amount < 1e-12);
  CHECK(gonio::model::worst_negative(metal).amount == 0.0);
  CHECK(gonio::model::worst_anisotropy(metal).amount < 1e-9);
  CHECK(gonio::model::find_largest_albedo(metal, 200).value < 1.0);
}

TEST_CASE("what breaks them is found, and where") {
  const unphysical f;
  const auto asymmetry = gonio::model::worst_asymmetry(f);
  CHECK(asymmetry.amount > 0.9);
  CHECK(asymmetry.median > 0.1);
  CHECK(asymmetry.median < asymmetry.amount);
  const auto [wi, wo] = asymmetry.at;
  CHECK(gonio::model::detail::relative_difference(f(wi, wo), f(wo, wi)) == doctest::Approx(asymmetry.amount));
  const auto negative = gonio::model::worst_negative(f);
  CHECK(negative.amount > 0.45);
  CHECK(negative.at.wi.z() > 0.95);
  CHECK(gonio::model::worst_anisotropy(
            gonio::model::anisotropic_ward(rgb::Ones(), {.roughness_x = 0.1, .roughness_y = 0.4}))
            .amount > 0.9);
}

TEST_CASE("colours differ by a share of the brighter one's largest channel") {
  using gonio::model::detail::relative_difference;
  CHECK(relative_difference(rgb(1, 2, 4), rgb(1, 2, 3)) == 0.25);
  CHECK(relative_difference(rgb(1, 2, 3), rgb(1, 2, 4)) == 0.25);
  CHECK(relative_difference(rgb::Zero(), rgb(0, 0, 0.1)) == 1.0);
  CHECK(relative_difference(rgb::Zero(), rgb::Zero()) == 0.0);
}

TEST_CASE("albedo: exact for Lambert, too much for Duer's lobe at grazing angles, and of tables, too") {
  const gonio::model::lambertian grey{.albedo = {0.2, 0.5, 0.9}};
  for (const double theta : {0.0, 0.6, 1.2})
    CHECK(((gonio::model::directional_albedo(grey, theta) - grey.albedo).abs() < 2e-3).all());
  const auto largest = gonio::model::find_largest_albedo(gonio::model::ward_duer(rgb::Ones(), {.roughness = 0.2}), 200);
  CHECK(largest.value > 1.2);
  CHECK(gonio::degrees(largest.theta) == doctest::Approx(88.0));
  const auto table = gonio::tabulate(grey, gonio::valid_cells(gonio::grid({30, 20, 20})));
  CHECK(gonio::model::directional_albedo(table, 0.5, 100)[2] == doctest::Approx(0.9).epsilon(0.02));
}
