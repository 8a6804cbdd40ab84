/// Fits of anisotropic lobes recover slopes, rotation and colours.

#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/model/fit_model.hpp>
#include <gonio/model/physical_properties.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string_view>

using gonio::rgb;
using gonio::model::analytic_brdf;
using gonio::model::analytic_lobe;
using gonio::model::lobe_kind;

namespace {

constexpr double pi = std::numbers::pi;

const lobe_kind& lambert() { return lobe_kind::of<gonio::model::lambert_shape>(); }

analytic_brdf beside_lambert(std::string_view name, const lobe_kind::values& parameters) {
  return analytic_brdf(
      {{lambert(), {0.1, 0.2, 0.05}, {}}, {gonio::model::lobe_kind_named(name), {0.8, 0.6, 0.4}, parameters}});
}

gonio::sample_set measured(const analytic_brdf& f, Eigen::Index count, double noise) {
  return gonio::sample_brdf(f, gonio::random_pairs(gonio::valid_cells(), count, 3), {.noise = noise}, 5);
}

/// The slopes and the rotation of a lobe, with the smaller slope first.
struct axes {
  double smooth, rough, rotation;

  explicit axes(const analytic_lobe& lobe)
      : smooth(lobe.parameters()[0]),
        rough(lobe.parameters()[1]),
        rotation(lobe.parameters()[lobe.kind().parameters().size() - 1]) {
    if (smooth <= rough) return;
    std::swap(smooth, rough);
    rotation += pi / 2;
  }
  /// Returns the angle between the axes in degrees.
  [[nodiscard]] double turn_from(double azimuth) const {
    return gonio::degrees(std::abs(std::remainder(rotation - azimuth, pi)));
  }
};

}  // namespace

TEST_CASE("an anisotropic fit to what a model made finds its parameters, at any rotation") {
  for (const double rotation : {-1.5, -0.9, 0.0, 0.4, 1.2, 1.57})
    for (const std::string_view name : {"ggx-anisotropic", "ward-anisotropic", "ward-bounded-anisotropic"}) {
      CAPTURE(name);
      CAPTURE(rotation);
      const bool is_ggx = name == "ggx-anisotropic";
      const analytic_brdf truth = beside_lambert(
          name, is_ggx ? lobe_kind::values{0.12, 0.35, 0.3, rotation} : lobe_kind::values{0.12, 0.35, rotation});
      const auto fit = gonio::model::fit_model({&lambert(), &truth.lobes()[1].kind()},
                                               gonio::model::fit_observations(measured(truth, 400, 0.0)));
      const axes found(fit.model.lobes()[1]);
      CHECK(found.smooth == doctest::Approx(0.12).epsilon(1e-4));
      CHECK(found.rough == doctest::Approx(0.35).epsilon(1e-4));
      CHECK(found.turn_from(rotation) < 0.01);
      CHECK((fit.model.lobes()[0].colour() - rgb(0.1, 0.2, 0.05)).abs().maxCoeff() < 1e-4);
    }
}

TEST_CASE("GGX's slopes and rotation come back from 200 samples with 2 % noise, as the tool fits") {
  const analytic_brdf truth = beside_lambert("ggx-anisotropic", {0.12, 0.35, 0.3, 0.5});
  const auto fit = gonio::model::fit_model(
      {&lambert(), &truth.lobes()[1].kind()}, gonio::model::fit_observations(measured(truth, 200, 0.02)), gonio::log(),
      {.norm = gonio::model::fit_norm::huber, .cosine_weighted = true, .largest_albedo = 1.0});
  const axes found(fit.model.lobes()[1]);
  MESSAGE("slopes ", found.smooth, " and ", found.rough, ", rotation off by ", found.turn_from(0.5), " degrees");
  CHECK(found.smooth == doctest::Approx(0.12).epsilon(0.03));
  CHECK(found.rough == doctest::Approx(0.35).epsilon(0.03));
  CHECK(found.turn_from(0.5) < 1.0);
}

TEST_CASE("an isotropic material is fitted with equal slopes, and an albedo is bounded at all azimuths") {
  const analytic_brdf isotropic = beside_lambert("ggx", {0.3, 0.2});
  const auto& kind = lobe_kind::of<gonio::model::anisotropic_ggx_shape>();
  const auto same =
      gonio::model::fit_model({&lambert(), &kind}, gonio::model::fit_observations(measured(isotropic, 300, 0.0)));
  const axes found(same.model.lobes()[1]);
  CHECK(found.rough / found.smooth == doctest::Approx(1.0).epsilon(1e-3));
  // Too bright: reflects four times as much as a white material.
  const analytic_brdf bright({{kind, rgb::Constant(4.0), {0.1, 0.5, 0.9, 0.7}}});
  const auto bounded = gonio::model::fit_model({&kind}, gonio::model::fit_observations(measured(bright, 200, 0.0)),
                                               gonio::log(), {.largest_albedo = 1.0});
  CHECK(gonio::model::find_largest_albedo(bounded.model, 100).value < 1.05);
}
