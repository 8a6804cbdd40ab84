#include "../golden.hpp"
#include <gonio/table/grid.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::cell_anchor;
using gonio::grid;

TEST_CASE("nearest cells agree with the reference") {
  const auto golden = golden_csv("coords.csv");
  const grid merl;
  for (std::size_t i = 0; i < golden.at("theta_h").size(); ++i) {
    CAPTURE(i);
    const auto cell = merl.nearest({golden.at("theta_h")[i], golden.at("theta_d")[i], golden.at("phi_d")[i]});
    CHECK(cell.theta_h == static_cast<int>(golden.at("ith")[i]));
    // Two of the special pairs are on a border between cells, where rounding decides.
    const double theta_d = merl.theta_d_coordinate(golden.at("theta_d")[i]) + 0.5;
    if (std::abs(theta_d - std::round(theta_d)) < 1e-9) continue;
    CHECK(cell.theta_d == static_cast<int>(golden.at("itd")[i]));
    CHECK(cell.phi_d == static_cast<int>(golden.at("ipd")[i]));
    CHECK(merl.linear(cell) == golden.at("linear")[i]);
  }
}

TEST_CASE("cells, linear indices, angles and nearest agree on any grid") {
  CHECK(rc::check([] {
    const auto extent = rc::gen::inRange(1, 40);
    const auto anchor = *rc::gen::element(cell_anchor::centre, cell_anchor::lower_corner);
    const grid any({*extent, *extent, *extent}, anchor);
    const std::size_t linear = *rc::gen::inRange<std::size_t>(0, any.size());
    const auto cell = any.cell(linear);
    RC_ASSERT(any.linear(cell) == linear);
    RC_ASSERT(any.nearest(any.angles(cell)) == cell);
  }));
}

TEST_CASE("MERL's conventions") {
  const grid centre;
  CHECK(centre.size() == 1'458'000);
  CHECK(gonio::degrees(centre.angles({0, 0, 0}).theta_h) == doctest::Approx(0.5 * 0.5 / 90));
  CHECK(gonio::degrees(centre.angles({89, 89, 179}).theta_d) == doctest::Approx(89.5));
  const grid corner({}, cell_anchor::lower_corner);
  CHECK(corner.angles({0, 0, 0}).theta_h == 0.0);
  CHECK(gonio::degrees(corner.angles({45, 10, 20}).theta_h) == doctest::Approx(22.5));
  CHECK(gonio::degrees(corner.angles({45, 10, 20}).phi_d) == doctest::Approx(20));
}

TEST_CASE("angles beyond the grid go to its border, phi_d wraps") {
  const grid merl;
  CHECK(merl.nearest({3.0, 3.0, 0.0}) == gonio::cell_index{89, 89, 0});
  CHECK(merl.nearest({0.0, 0.0, -0.001}) == gonio::cell_index{0, 0, 179});
  // With values at lower corners, the node nearest to a phi_d just below pi is the one at phi_d = 0.
  CHECK(grid({}, cell_anchor::lower_corner).nearest({0.0, 0.0, std::numbers::pi - 1e-4}).phi_d == 0);
}

TEST_CASE("impossible extents are refused") {
  CHECK_THROWS_AS(grid({0, 90, 180}), gonio::error);
  CHECK_THROWS_AS(grid({90, -1, 180}), gonio::error);
  CHECK_THROWS_WITH_AS(grid({90, 90, 5000}), doctest::Contains("90 x 90 x 5000"), gonio::error);
}
