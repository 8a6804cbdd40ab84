#include <gonio/table/location.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>

using gonio::half_difference;
using gonio::valid_cells;

namespace {

half_difference any_angles() {
  const auto fraction = rc::gen::map(rc::gen::inRange(0, 1'000'001), [](int i) { return i * 1e-6; });
  const double half_pi = std::numbers::pi / 2;
  return {*fraction * half_pi, *fraction * half_pi, *fraction * 2 * std::numbers::pi};
}

}  // namespace

TEST_CASE("weights are positive and sum to one everywhere, over valid cells") {
  for (const auto anchor : {gonio::cell_anchor::centre, gonio::cell_anchor::lower_corner}) {
    const valid_cells cells(gonio::grid({9, 7, 11}, anchor));
    CHECK(rc::check([&] {
      const auto at = gonio::locate(cells, any_angles());
      RC_ASSERT(at.count >= 1);
      double sum = 0;
      for (Eigen::Index corner = 0; corner < at.count; ++corner) {
        RC_ASSERT(at.weight[corner] > 0.0);
        RC_ASSERT(at.cell[corner] < cells.size());
        sum += at.weight[corner];
      }
      RC_ASSERT(std::abs(sum - 1.0) < 1e-12);
    }));
  }
}

TEST_CASE("a node is located at its own cell alone") {
  for (const auto anchor : {gonio::cell_anchor::centre, gonio::cell_anchor::lower_corner}) {
    const valid_cells cells(gonio::grid({9, 7, 11}, anchor));
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
      const auto at = gonio::locate(cells, cells.angles(cell));
      REQUIRE(at.count == 1);
      REQUIRE(at.cell[0] == cell);
      REQUIRE(gonio::locate_cell(cells, cell).cell[0] == cell);
    }
  }
}

TEST_CASE("a field that is linear in the grid's coordinates is reproduced inside the valid region") {
  const valid_cells cells(gonio::grid({30, 20, 24}));
  const auto& grid = cells.grid();
  const auto field = [&](const half_difference& angles) {
    return 2.0 * grid.theta_h_coordinate(angles.theta_h) - 3.0 * grid.theta_d_coordinate(angles.theta_d) + 7.0;
  };
  CHECK(rc::check([&] {
    half_difference angles = any_angles();
    angles.theta_h = std::max(angles.theta_h * 0.3, grid.theta_h(0));
    angles.theta_d = std::max(angles.theta_d * 0.6, grid.theta_d(0));
    const auto at = gonio::locate(cells, angles);
    const double value = gonio::interpolate(
        at, [&](std::size_t cell) { return field(cells.angles(cell)); }, 0.0);
    RC_ASSERT(std::abs(value - field(angles)) < 1e-9);
  }));
}

TEST_CASE("phi_d wraps: both sides of zero see the same neighbours") {
  const valid_cells cells(gonio::grid({9, 9, 12}));
  const auto below = gonio::locate(cells, {0.2, 0.4, -1e-5}), above = gonio::locate(cells, {0.2, 0.4, 1e-5});
  const auto value = [&](std::size_t cell) { return cells.angles(cell).phi_d; };
  CHECK(gonio::interpolate(below, value, 0.0) == doctest::Approx(gonio::interpolate(above, value, 0.0)).epsilon(1e-3));
}

TEST_CASE("a location knows its horizon") {
  const valid_cells cells;
  CHECK(gonio::locate(cells, {0.1, 0.2, 0.3}).above_horizon());
  CHECK_FALSE(gonio::locate(cells, {1.2, 1.2, 0.0}).above_horizon());
}
