#include <gonio/table/brdf_table.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>

using gonio::brdf_table;
using gonio::direction;
using gonio::rgb;
using gonio::valid_cells;

namespace {

/// A smooth, reciprocal BRDF with different values in each channel.
struct smooth_brdf {
  rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
    const auto angles = gonio::to_half_difference(wi, wo);
    return {std::cos(angles.theta_h), 0.3 + 0.1 * std::cos(angles.theta_d), 0.2 + 0.05 * std::cos(2 * angles.phi_d)};
  }
};

}  // namespace

TEST_CASE("a tabulated BRDF is the BRDF at the cells, and near it between them") {
  const smooth_brdf f;
  const brdf_table table = gonio::tabulate(f, valid_cells());
  CHECK(rc::check([&] {
    const double theta = *rc::gen::inRange(0, 80) * std::numbers::pi / 180;
    const auto wi = gonio::spherical_direction(theta, *rc::gen::inRange(0, 360) * std::numbers::pi / 180);
    const auto wo = gonio::spherical_direction(*rc::gen::inRange(0, 80) * std::numbers::pi / 180, 0.3);
    RC_ASSERT((table(wi, wo) - f(wi, wo)).abs().maxCoeff() < 2e-3);
    RC_ASSERT((gonio::nearest_lookup(table)(wi, wo) - f(wi, wo)).abs().maxCoeff() < 3e-2);
  }));
  const auto [wi, wo] = to_directions(table.cells().angles(12345));
  CHECK((table(wi, wo) - f(wi, wo)).abs().maxCoeff() < 1e-6);
}

TEST_CASE("below the horizon a table is zero, at grazing directions finite") {
  const brdf_table table = gonio::tabulate(smooth_brdf(), valid_cells(gonio::grid({20, 20, 20})));
  const direction up(0, 0, 1);
  for (const auto& down : {direction(0, 0, -1), direction(1, 0, 0), gonio::spherical_direction(2.0, 1.0)}) {
    CHECK((table(up, down) == 0.0).all());
    CHECK((gonio::nearest_lookup(table)(down, up) == 0.0).all());
  }
  CHECK(table(gonio::spherical_direction(1.5707, 0), gonio::spherical_direction(1.5707, 3)).isFinite().all());
}

TEST_CASE("the number of threads does not change a byte") {
  const valid_cells cells(gonio::grid({30, 30, 60}));
  const auto one = gonio::tabulate(smooth_brdf(), cells, {1}), many = gonio::tabulate(smooth_brdf(), cells, {5});
  CHECK(std::ranges::equal(one.values(), many.values()));
}

TEST_CASE("resampling keeps a table on its own cells and approximates it on others") {
  const valid_cells fine(gonio::grid({60, 60, 60})), coarse(gonio::grid({15, 20, 12}));
  const brdf_table table = gonio::tabulate(smooth_brdf(), fine);
  CHECK(std::ranges::equal(gonio::resample(table, valid_cells(gonio::grid({60, 60, 60}))).values(), table.values()));
  const brdf_table other = gonio::resample(table, coarse), exact = gonio::tabulate(smooth_brdf(), coarse);
  for (Eigen::Index cell = 0; cell < std::ssize(coarse); ++cell) {
    // At the horizon, the last valid value extends over at most one cell. Elsewhere the error is quadratic.
    const auto cosine = cosines(coarse.angles(cell));
    const double tolerance = std::min(cosine.i, cosine.o) > 0.2 ? 2e-3 : 5e-2;
    REQUIRE((other.at(cell) - exact.at(cell)).abs().maxCoeff() < tolerance);
  }
}

TEST_CASE("negative values are kept and a wrong number of values is refused") {
  brdf_table table(valid_cells(gonio::grid({3, 3, 3})));
  table.set(2, rgb(-0.5, 1.0, 2.0));
  CHECK(table.at(2).x() == -0.5);
  CHECK_THROWS_WITH_AS(brdf_table(table.cells(), std::vector<float>(7)), doctest::Contains("got 7"), gonio::error);
}
