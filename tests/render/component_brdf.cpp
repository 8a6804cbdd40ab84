#include "../sampler_checks.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/render/component_brdf.hpp>
#include <gonio/render/half_vector_sampler.hpp>

#include <doctest/doctest.h>

#include <limits>

using gonio::direction;
using gonio::rgb;
using gonio::render::component_brdf;
using gonio::render::interpolation;
using gonio::render::shared_components;

static_assert(gonio::render::log_relative_components<gonio::log_relative_pca>);

namespace {

const gonio::log_relative_pca& some_components() {
  static const auto prior = learn(synthetic_materials(gonio::valid_cells(gonio::grid({20, 15, 30})), 8), 6);
  return prior;
}

template <class Brdf>
double worst_difference(const Brdf& f, const gonio::fitted_brdf<gonio::log_relative_pca>& expected) {
  sampler_checks::uniform_numbers number(4);
  double worst = 0.0;
  for (int i = 0; i < 3'000; ++i) {
    const auto any = [&] {
      const double z = 1e-3 + 0.999 * number(), azimuth = 6.28 * number();
      return gonio::spherical_direction(std::acos(z), azimuth);
    };
    const direction wi = any(), wo = any();
    const rgb value = expected(wi, wo), found = f(wi, wo);
    worst = std::max(worst, ((found - value).abs() / (value + 0.01)).maxCoeff());
  }
  return worst;
}

}  // namespace

TEST_CASE("component brdf: it is the fit whose weights it has") {
  gonio::solution found;
  found.weights = some_components().weights_of(3);
  const gonio::fitted_brdf expected(some_components(), found);
  const shared_components<float> components(some_components());
  const shared_components<Eigen::half> in_half(some_components());
  CHECK(worst_difference(component_brdf(components, found.weights), expected) < 1e-4);
  CHECK(worst_difference(component_brdf(in_half, found.weights), expected) < 0.02);
  CHECK(in_half.memory() < 0.51 * static_cast<double>(components.memory()) + 3e3);
  CHECK(component_brdf(components, found.weights).memory() < 200u);
}

TEST_CASE("component brdf: at the nodes, nearest and trilinear look-up are the same") {
  const shared_components<float> components(some_components());
  const Eigen::MatrixXd weights = some_components().weights_of(1);
  const component_brdf<float, interpolation::nearest> nearest(components, weights);
  const component_brdf<float, interpolation::trilinear> trilinear(components, weights);
  for (Eigen::Index cell = 0; cell < some_components().cells().size(); cell += 11) {
    const auto [wi, wo] = gonio::to_directions(some_components().cells().angles(cell));
    const rgb near = nearest(wi, wo), between = trilinear(wi, wo);
    CHECK(((near - between).abs() < 1e-4 * (near + 0.01)).all());
    const Eigen::Array3f in_float = trilinear(Eigen::Vector3f(wi.cast<float>()), Eigen::Vector3f(wo.cast<float>()));
    CHECK(((in_float.cast<double>() - between).abs() < 2e-3 * (between + 0.01)).all());
  }
}

TEST_CASE("component brdf: fewer components are the fit by fewer") {
  gonio::solution found;
  found.weights = some_components().weights_of(2).topRows(2);
  const gonio::fitted_brdf expected(some_components().truncated(2), found);
  const shared_components<float> components(some_components(), 2);
  CHECK(worst_difference(component_brdf(components, found.weights), expected) < 1e-4);
}

TEST_CASE("component brdf: it is sampled like any other") {
  const shared_components<float> components(some_components());
  const gonio::render::half_vector_sampler sampler{component_brdf(components, some_components().weights_of(0))};
  const direction wo = gonio::spherical_direction(0.7, 0.2);
  CHECK(sampler_checks::chi_square_p_value(sampler, wo, 50'000, 1) > 0.01);
  CHECK(sampler_checks::integral_of_pdf(sampler, wo) == doctest::Approx(1.0).epsilon(0.005));
}

TEST_CASE("component brdf: bad input") {
  const shared_components<float> components(some_components());
  Eigen::MatrixXd weights = some_components().weights_of(0);
  const component_brdf good(components, weights);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const direction up(0.0, 0.0, 1.0);
  for (const direction& bad : {direction(0.6, 0.0, -0.8), direction(1.0, 0.0, 0.0), direction(nan, 0.0, 1.0)}) {
    CHECK((good(bad, up) == 0.0).all());
    CHECK((good(up, bad) == 0.0).all());
  }
  CHECK_THROWS_WITH_AS(shared_components<float>(some_components(), 7), "cannot take 7 of 6 components", gonio::error);
  CHECK_THROWS_WITH_AS(component_brdf(components, Eigen::MatrixXd::Zero(5, 3)),
                       "a BRDF of 6 components needs one finite weight per component for each of 3 channels, not 5 x 3",
                       gonio::error);
  weights(0, 0) = nan;
  CHECK_THROWS_AS(component_brdf(components, weights), gonio::error);
}
