#include "../io/scratch.hpp"
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/model/polar_grid_brdf.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

using gonio::direction;
using gonio::radians;
using gonio::rgb;
using gonio::spherical_direction;
using gonio::model::polar_grid_brdf;
using scratch::check_refused;

namespace {

/// 2 x 2 x 2 cells of one channel with the values 0 to 7.
polar_grid_brdf counted() { return {{2, 2}, {0, 1, 2, 3, 4, 5, 6, 7}}; }

double value(const polar_grid_brdf& f, double theta_i, double theta_o, double phi) {
  return f.as_measured(spherical_direction(radians(theta_i), radians(20.0)),
                       spherical_direction(radians(theta_o), radians(20.0 + phi)))[1];
}

/// 0.2 on one side of the plane of light and normal, 0.4 on the other.
struct lopsided_brdf {
  rgb operator()(const direction& wi, const direction& wo) const noexcept {
    return rgb::Constant(wi.x() * wo.y() - wi.y() * wo.x() > 0.0 ? 0.2 : 0.4);
  }
};

}  // namespace

TEST_CASE("polar grid: of two sides of the plane of incidence it has the mean") {
  const polar_grid_brdf f = gonio::model::tabulate_polar(lopsided_brdf{}, {3, 4});
  for (const float value : f.values()) CHECK(value == doctest::Approx(0.3));
}

TEST_CASE("polar grid: values stand at the centres, theta_i slowest and the azimuth fastest") {
  const polar_grid_brdf f = counted();
  CHECK(f.channels() == 1);
  CHECK(value(f, 22.5, 22.5, 45.0) == doctest::Approx(0.0));
  CHECK(value(f, 22.5, 22.5, 135.0) == doctest::Approx(1.0));
  CHECK(value(f, 22.5, 67.5, 45.0) == doctest::Approx(2.0));
  CHECK(value(f, 67.5, 22.5, 45.0) == doctest::Approx(4.0));
  CHECK(value(f, 67.5, 67.5, -135.0) == doctest::Approx(7.0));
  CHECK(value(f, 67.5, 67.5, 225.0) == doctest::Approx(7.0));
  // Linear between the centres, constant outside them.
  CHECK(value(f, 45.0, 45.0, 90.0) == doctest::Approx(3.5));
  CHECK(value(f, 22.5, 30.0, 45.0) == doctest::Approx(2.0 / 6.0));
  CHECK(value(f, 1.0, 1.0, 0.0) == doctest::Approx(0.0));
  CHECK(value(f, 89.0, 89.0, 180.0) == doctest::Approx(7.0));
}

TEST_CASE("polar grid: the BRDF is the mean of both orders, and nothing below the horizon") {
  const polar_grid_brdf f = counted();
  const direction wi = spherical_direction(radians(22.5), 0.0), wo = spherical_direction(radians(67.5), radians(45.0));
  CHECK(f.as_measured(wi, wo)[0] == doctest::Approx(2.0));
  CHECK(f.as_measured(wo, wi)[0] == doctest::Approx(4.0));
  CHECK((f(wi, wo) - 3.0).abs().maxCoeff() < 1e-12);
  CHECK((f(wi, wo) == f(wo, wi)).all());
  CHECK((f(direction(0.6, 0.0, -0.8), wo) == 0.0).all());
  CHECK((f(wi, direction(1.0, 0.0, 0.0)) == 0.0).all());
  CHECK(f(direction(0, 0, 1), direction(0, 0, 1)).allFinite());
}

TEST_CASE("polar grid: a tabulated BRDF has its values at the centres, and near them between") {
  const gonio::model::ggx rough{.alpha = 0.5, .f0 = rgb(0.9, 0.6, 0.3)};
  const gonio::model::polar_grid grid{24, 30};
  const polar_grid_brdf f = gonio::model::tabulate_polar(rough, grid);
  CHECK(f.channels() == 3);
  std::mt19937 random(7);
  for (int round = 0; round < 50; ++round) {
    const Eigen::Index cell = std::uniform_int_distribution<Eigen::Index>(0, grid.size() - 1)(random);
    const auto [wi, wo] = gonio::model::directions_of(grid, cell);
    CHECK((f(wi, wo) - rough(wi, wo)).abs().maxCoeff() <= 1e-6 * rough(wi, wo).maxCoeff());
  }
  const direction wi = spherical_direction(0.4, 0.0), wo = spherical_direction(0.7, 2.0);
  CHECK((f(wi, wo) / rough(wi, wo) - 1.0).abs().maxCoeff() < 0.02);
  const polar_grid_brdf threaded = gonio::model::tabulate_polar(rough, grid, gonio::thread_count{3});
  CHECK(std::ranges::equal(threaded.values(), f.values()));
}

TEST_CASE("polar grid: what is grey everywhere has one channel") {
  const gonio::model::lambertian grey{.albedo = rgb::Constant(0.5)};
  const polar_grid_brdf f = gonio::model::tabulate_polar(grey, {3, 4});
  CHECK(f.channels() == 1);
  REQUIRE(f.values().size() == 36);
  CHECK(f.values()[35] == doctest::Approx(0.5 / std::numbers::pi));
}

TEST_CASE("polar grid: values that do not fit and grids of no cells are refused") {
  using values = std::vector<float>;
  check_refused([] { return polar_grid_brdf({2, 2}, values(9)); }, {"2 x 2 x 2", "9 in all"});
  check_refused([] { return polar_grid_brdf({0, 2}, values()); }, {"0 x 0 x 2"});
  check_refused([] { return polar_grid_brdf({Eigen::Index{1} << 40, 1}, values(9)); }, {"9 in all"});
  check_refused([] { return polar_grid_brdf({1, 1}, {std::numeric_limits<float>::quiet_NaN()}); }, {"not finite"});
  const gonio::model::lambertian grey{.albedo = rgb::Constant(0.5)};
  check_refused([&] { return gonio::model::tabulate_polar(grey, {2000, 10}); }, {"1 to 360", "2000"});
  check_refused([&] { return gonio::model::tabulate_polar(grey, {0, 10}); }, {"1 to 360"});
  check_refused([&] { return gonio::model::tabulate_polar(grey, {361, 1}); }, {"1 to 360", "361"});
  check_refused([&] { return gonio::model::tabulate_polar(grey, {1, 721}); }, {"1 to 720", "721"});
  CHECK(gonio::model::tabulate_polar(grey, {360, 1}).values().size() == 360 * 360);
  CHECK(gonio::model::tabulate_polar(grey, {1, 720}).values().size() == 720);
}
