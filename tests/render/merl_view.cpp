#include <gonio/core/error.hpp>
#include <gonio/render/half_vector_sampler.hpp>
#include <gonio/render/merl_view.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <random>

using gonio::render::interpolation;
using gonio::render::lookup_table;
using gonio::render::merl_view;

namespace {

const gonio::grid small_grid({15, 12, 18});

/// Planes of positive numbers, some cells marked as empty.
std::vector<double> random_planes() {
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> value(0.0, 900.0);
  std::vector<double> planes(3 * small_grid.size());
  for (double& number : planes) number = value(generator);
  for (Eigen::Index cell = 0; cell < small_grid.size(); cell += 11)
    for (Eigen::Index channel = 0; channel < 3; ++channel) planes[channel * small_grid.size() + cell] = -1.0;
  return planes;
}

gonio::direction any_direction() {
  const auto share = [] { return (*rc::gen::inRange(0, 100001)) / 1e5; };
  return gonio::spherical_direction(std::acos(1.0 - share()), 6.4 * share());
}

template <interpolation Interpolation>
void reads_as_a_lookup_table() {
  const std::vector<double> planes = random_planes();
  const merl_view<Interpolation> view(planes, small_grid);
  const auto copied = lookup_table<double, Interpolation>::from_merl(planes, small_grid);
  CHECK(rc::check([&] {
    const gonio::direction wi = any_direction(), wo = any_direction();
    const gonio::rgb seen = view(wi, wo), read = copied(wi, wo);
    // The sum of eight values is computed in another order.
    const double rounding = Interpolation == interpolation::nearest ? 0.0 : 1e-14;
    RC_ASSERT(((seen - read).abs() <= rounding * read).all());
    const Eigen::Vector3f i = wi.cast<float>(), o = wo.cast<float>();
    RC_ASSERT((view(i, o) - copied(i, o)).abs().maxCoeff() <= 1e-6f);
  }));
}

}  // namespace

TEST_CASE("merl view: reads as a look-up table of the same planes, nearest and trilinear") {
  reads_as_a_lookup_table<interpolation::nearest>();
  reads_as_a_lookup_table<interpolation::trilinear>();
}

TEST_CASE("merl view: nothing is copied") {
  std::vector<double> planes = random_planes();
  const merl_view<> view(planes, small_grid);
  CHECK(view.planes().data() == planes.data());
  const gonio::direction wi = gonio::spherical_direction(0.4, 0.0), wo = gonio::spherical_direction(0.3, 2.0);
  std::ranges::fill(planes, 300.0);
  CHECK(view(wi, wo).x() == doctest::Approx(300.0 * gonio::merl_scale[0]));
  CHECK(view(wi, wo).z() == doctest::Approx(300.0 * gonio::merl_scale[2]));
  static_assert(!std::is_constructible_v<merl_view<>, std::vector<double>&&>);
}

TEST_CASE("merl view: is sampled by importance as any BRDF") {
  const std::vector<double> planes = random_planes();
  const merl_view<> view(planes, small_grid);
  const gonio::render::half_vector_sampler sampler(view);
  const gonio::direction wo = gonio::spherical_direction(0.5, 1.0);
  const auto [wi, weight, pdf] = sampler.sample(wo, 0.3, 0.6);
  REQUIRE(pdf > 0.0);
  CHECK((weight * pdf - view(wi, wo) * wi.z()).abs().maxCoeff() < 1e-9);
}

TEST_CASE("merl view: planes of another size are refused") {
  const std::vector<double> planes(3 * small_grid.size() - 1);
  CHECK_THROWS_WITH_AS((merl_view<>(planes, small_grid)),
                       "a MERL table needs three planes of 3240 values, not 9719 values", gonio::error);
}
