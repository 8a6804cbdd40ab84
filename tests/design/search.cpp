#include "../synthetic_materials.hpp"
#include <gonio/design/search.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <set>

using gonio::design::capture_plan;

namespace {

/// Returns the sum of the distances, in cells, from three locations to the nearest cell of a design.
double distance_from_locations(std::span<const Eigen::Index> cells) {
  const auto& grid = small_cells().grid();
  double sum = 0.0;
  for (const gonio::cell_index& location : {gonio::cell_index{1, 1, 0}, {4, 3, 5}, {6, 1, 2}}) {
    double nearest = 1e9;
    for (const Eigen::Index cell : cells) {
      const gonio::cell_index at = grid.cell(small_cells().linear(cell));
      const int round = std::abs(at.phi_d - location.phi_d), phi = std::min(round, grid.extents().phi_d - round);
      nearest = std::min(nearest, std::abs(at.theta_h - location.theta_h) + std::abs(at.theta_d - location.theta_d) +
                                      static_cast<double>(phi));
    }
    sum += nearest;
  }
  return sum;
}

const gonio::design::point_geometry& small_points() {
  static const gonio::design::point_geometry points(small_cells());
  return points;
}

/// Returns true if no plan with one cell moved by one step is better.
bool no_step_improves(const capture_plan& plan) {
  capture_plan copy = plan;
  for (Eigen::Index position = 0; position < std::ssize(plan.candidates); ++position)
    if (gonio::design::detail::move_one(small_points(), distance_from_locations, copy, position, 1)) return false;
  return true;
}

}  // namespace

TEST_CASE("descent ends where no step improves") {
  CHECK(rc::check([] {
    const auto any = rc::gen::inRange<Eigen::Index>(0, small_cells().size());
    const auto n = *rc::gen::inRange<Eigen::Index>(1, 5);
    const auto cells = *rc::gen::unique<std::vector<Eigen::Index>>(n, any);
    const capture_plan found = gonio::design::descend(small_points(), distance_from_locations, {cells, 0.0}, 3);
    RC_ASSERT(found.value <= distance_from_locations(cells));
    RC_ASSERT(found.value == distance_from_locations(found.candidates));
    RC_ASSERT(no_step_improves(found));
    RC_ASSERT(std::ssize(std::set<Eigen::Index>(found.candidates.begin(), found.candidates.end())) == n);
  }));
}

TEST_CASE("growing finds all three locations from many tries, and the same for a seed") {
  const auto grown = [](Eigen::Index n, Eigen::Index tries, std::uint64_t seed) {
    return gonio::design::grow_and_descend(small_points(), distance_from_locations, n, tries, seed);
  };
  CHECK(grown(3, 200, 1).value == 0.0);
  CHECK(grown(3, 5, 2).candidates == grown(3, 5, 2).candidates);
  CHECK(grown(1, 1, 4).candidates.size() == 1);
  CHECK(no_step_improves(grown(2, 1, 5)));
  CHECK_THROWS_WITH_AS(static_cast<void>(grown(0, 5, 1)), doctest::Contains("cannot choose 0"), gonio::error);
  CHECK_THROWS_AS(static_cast<void>(grown(small_cells().size() + 1, 5, 1)), gonio::error);
}

TEST_CASE("values may be negative or infinite: ties and rounding are no improvements, and every search ends") {
  using gonio::design::detail::improves;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double on : {-3.0, 3.0}) {
    CHECK_FALSE(improves(on, on));
    CHECK_FALSE(improves(std::nextafter(on, -infinity), on));
    CHECK(improves(on - 1e-6, on));
    CHECK_FALSE(improves(on - 1e-7, on, 1e-6));
  }
  CHECK(improves(0.0, infinity));
  CHECK_FALSE(improves(infinity, infinity));
  CHECK(improves(-1e-300, 0.0));

  const auto below_zero = [](std::span<const Eigen::Index> cells) { return distance_from_locations(cells) - 100.0; };
  const capture_plan found = gonio::design::grow_and_descend(small_points(), below_zero, 3, 20, 6),
                     same = gonio::design::grow_and_descend(small_points(), distance_from_locations, 3, 20, 6);
  CHECK(found.candidates == same.candidates);
  CHECK(found.value == doctest::Approx(same.value - 100.0));
}

TEST_CASE("random swaps never make it worse, and all cells are a choice, too") {
  double before = 1e9;
  for (const Eigen::Index swaps : {0u, 10u, 100u, 5000u}) {
    const capture_plan found = gonio::design::swap_at_random(small_points(), distance_from_locations, 3, swaps, 7);
    CHECK(found.value <= before);
    CHECK(found.value == distance_from_locations(found.candidates));
    before = found.value;
  }
  CHECK(before <= 3.0);
  CHECK(gonio::design::swap_at_random(small_points(), distance_from_locations, small_cells().size(), 10, 1).value ==
        0.0);
  CHECK_THROWS_AS(static_cast<void>(gonio::design::swap_at_random(small_points(), distance_from_locations, 0, 1)),
                  gonio::error);
}

TEST_CASE("no search chooses what the constraint excludes") {
  gonio::design::capture_constraint constraint;
  constraint.viewer.largest = gonio::radians(50);
  const gonio::design::point_geometry points(small_cells(), constraint);
  const auto all_allowed = [&](const capture_plan& plan) {
    return std::ranges::all_of(plan.candidates, [&](Eigen::Index cell) { return points.allows(cell); });
  };
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    CHECK(all_allowed(gonio::design::grow_and_descend(points, distance_from_locations, 3, 20, seed)));
    CHECK(all_allowed(gonio::design::swap_at_random(points, distance_from_locations, 3, 100, seed)));
  }
}
