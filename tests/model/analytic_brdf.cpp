#include "physical.hpp"
#include <gonio/model/analytic_brdf.hpp>

#include <set>

namespace {

/// Returns random parameters within their bounds.
gonio::model::lobe_kind::values any_parameters(const gonio::model::lobe_kind& kind) {
  gonio::model::lobe_kind::values values{};
  for (std::size_t i = 0; i < kind.parameters().size(); ++i) {
    const gonio::model::shape_parameter& about = kind.parameters()[i];
    const double share = 0.02 + 0.9 * any_fraction();
    // Excludes highlights so narrow that differences mean nothing.
    const double low = about.logarithmic ? about.lowest + 0.05 : about.lowest,
                 high = about.logarithmic ? std::min(about.highest, 200.0) : about.highest;
    values[i] = about.logarithmic ? low * std::pow(high / low, share) : low + share * (high - low);
  }
  return values;
}

}  // namespace

TEST_CASE("slopes are exact: those of central differences, for every kind") {
  for (const gonio::model::lobe_kind* kind : gonio::model::lobe_kinds()) {
    CAPTURE(kind->name());
    int slopes_seen = 0, compared = 0;
    CHECK(rc::check([&] {
      const auto parameters = any_parameters(*kind);
      const gonio::direction wi = any_direction(), wo = any_direction();
      RC_PRE(wi.z() > 0.05 && wo.z() > 0.05);
      const gonio::model::lobe_geometry at(wi, wo);
      gonio::model::lobe_kind::values slopes{};
      const double value = kind->value_and_slopes(at, parameters, slopes);
      RC_ASSERT(std::abs(value - kind->value(at, parameters)) <= 1e-12 * value);
      for (std::size_t i = 0; i < kind->parameters().size(); ++i) {
        ++slopes_seen;
        const double step = 1e-5 * std::max(std::abs(parameters[i]), 0.01);
        const auto difference_by = [&](double distance) {
          auto up = parameters, down = parameters;
          up[i] += distance;
          down[i] -= distance;
          return (kind->value(at, up) - kind->value(at, down)) / (2.0 * distance);
        };
        // Lafortune's scale has a kink at the mirror direction.
        if (kind->name() == "lafortune" && std::abs(std::abs(parameters[0]) - pi / 4) < 1e-3) continue;
        const double difference = difference_by(step), scale = std::abs(difference) + value / std::abs(parameters[i]);
        // At its border, a lobe with a small exponent is arbitrarily steep, and differences depend on their step.
        if (std::abs(difference - difference_by(step / 2.0)) > 2e-6 * scale) continue;
        ++compared;
        RC_ASSERT(std::abs(slopes[i] - difference) <= 1e-5 * scale + 1e-12);
      }
    }));
    CHECK(2 * compared >= slopes_seen);
  }
}

TEST_CASE("every kind keeps what a BRDF must keep, at its typical parameters") {
  for (const gonio::model::lobe_kind* kind : gonio::model::lobe_kinds()) {
    CAPTURE(kind->name());
    const gonio::model::analytic_brdf f({gonio::model::analytic_lobe(*kind, {0.1, 0.2, 0.9}, kind->typical())});
    check_finite_at_special_pairs_and_zero_below_the_horizon(f);
    check_reciprocal_isotropic_and_not_negative(f);
  }
}

TEST_CASE("kinds have names of their own, by which they are found, and parameters that are described") {
  std::set<std::string_view> names;
  for (const gonio::model::lobe_kind* kind : gonio::model::lobe_kinds()) {
    CHECK(names.insert(kind->name()).second);
    CHECK(gonio::model::lobe_kind_named(kind->name()) == *kind);
    for (const gonio::model::shape_parameter& about : kind->parameters()) {
      CAPTURE(about.name);
      CHECK(about.lowest < about.typical);
      CHECK(about.typical < about.highest);
      CHECK((!about.logarithmic || about.lowest > 0.0));
    }
  }
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::model::lobe_kind_named("plastic")),
                       doctest::Contains("no lobe named 'plastic'; the names are lambert, phong"), gonio::error);
}

TEST_CASE("a lobe chosen at run time is the model of that name") {
  const auto& kind = gonio::model::lobe_kind::of<gonio::model::phong_blinn_shape>();
  const gonio::model::analytic_lobe lobe(kind, {0.1, 0.2, 0.3}, {25.0, 0.4});
  const auto model = lobe.as<gonio::model::phong_blinn_shape>();
  CHECK(model.shape().shininess == 25.0);
  CHECK(model.shape().alpha == 0.4);
  const auto wi = gonio::spherical_direction(0.4, 0.0), wo = gonio::spherical_direction(0.5, 3.0);
  CHECK((gonio::model::analytic_brdf({lobe})(wi, wo) == model(wi, wo)).all());
  CHECK((gonio::model::analytic_brdf({lobe, lobe})(wi, wo) == 2.0 * model(wi, wo)).all());
  CHECK((gonio::model::analytic_brdf()(wi, wo) == 0.0).all());
  CHECK_THROWS_WITH_AS(static_cast<void>(lobe.as<gonio::model::lambert_shape>()), "a lobe is phong-blinn, not lambert",
                       gonio::error);
}

TEST_CASE("parameters that are out of bounds are refused by name") {
  const auto& kind = gonio::model::lobe_kind::of<gonio::model::ggx_shape>();
  const auto build = [&](const gonio::rgb& colour, const gonio::model::lobe_kind::values& values) {
    return gonio::model::analytic_lobe(kind, colour, values);
  };
  CHECK_THROWS_WITH_AS(static_cast<void>(build(gonio::rgb::Ones(), {2.0, 0.1})),
                       "ggx: alpha must be from 0.002000 to 1.000000, not 2.000000", gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(build(gonio::rgb::Ones(), {0.2, -0.1})), doctest::Contains("ggx: f0"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(build({-1.0, 0.0, 0.0}, {0.2, 0.1})), doctest::Contains("colour"),
                       gonio::error);
}
