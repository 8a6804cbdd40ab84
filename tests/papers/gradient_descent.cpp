#include "papers/nielsen2015/gradient_descent.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace {

/// How far points are from some cells of a grid, each from its own: any plan moves towards them one axis at a time or
/// along the diagonal.
struct distance_to_targets {
  gonio::valid_cells cells;
  std::vector<gonio::half_difference> targets;

  double operator()(std::span<const Eigen::Index> candidates) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const gonio::half_difference at = cells.angles(candidates[i]), &target = targets[i % targets.size()];
      sum += std::pow(at.theta_h - target.theta_h, 2) + std::pow(at.theta_d - target.theta_d, 2) +
             std::pow(at.phi_d - target.phi_d, 2);
    }
    return sum;
  }
};

}  // namespace

TEST_CASE("a descent along the gradient ends in the minimum of a parabola, up to a cell") {
  const gonio::valid_cells cells(gonio::grid({30, 30, 36}));
  const gonio::design::point_geometry points(cells);
  const distance_to_targets objective{cells, {{0.3, 0.6, 1.5}}};
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto plan = papers::grow_along_gradient(points, objective, 1, seed);
    const gonio::half_difference found = cells.angles(plan.candidates[0]);
    CHECK(found.theta_h == doctest::Approx(0.3).epsilon(0.2));
    CHECK(found.theta_d == doctest::Approx(0.6).epsilon(0.2));
    CHECK(found.phi_d == doctest::Approx(1.5).epsilon(0.2));
    CHECK(plan.value == objective(plan.candidates));
  }
}

TEST_CASE("a descent along the gradient is never worse than its start, and keeps its candidates different") {
  const gonio::valid_cells cells(gonio::grid({12, 12, 12}));
  const gonio::design::point_geometry points(cells);
  const distance_to_targets objective{cells, {{0.3, 0.6, 1.5}}};  // all want the same cell
  const gonio::design::capture_plan start{{5, 700, 900}};
  for (const std::vector<int>& lengths : {std::vector{1}, {3, 1}, {9, 3, 1}}) {
    const auto plan = papers::descend_along_gradient(points, objective, start, 7, lengths);
    CHECK(plan.value < objective(start.candidates));
    CHECK(plan.candidates[0] != plan.candidates[1]);
    CHECK(plan.candidates[1] != plan.candidates[2]);
    CHECK(plan.candidates[0] != plan.candidates[2]);
  }
}

TEST_CASE("a step is clipped where it leaves the valid cells") {
  const gonio::valid_cells cells(gonio::grid({12, 12, 12}));
  const gonio::design::point_geometry points(cells);
  const Eigen::Index corner = cells.representative(cells.grid().linear(cells.grid().nearest({0.0, 0.0, 0.0})));
  const auto to = papers::stepped_or_clipped(points, corner, {-3, 2, 0});
  REQUIRE(to.has_value());
  CHECK(*to == *points.stepped(corner, {0, 2, 0}));
}
