#include "scattered_pairs.hpp"
#include <gonio/render/cell_finder.hpp>
#include <gonio/table/valid_cells.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <limits>
#include <random>

using gonio::direction;
using gonio::render::cell_finder;
using scattered::outside;
using scattered::scattered_pair;

namespace {

/// Checks the distance, in cells along each axis, between the exact location and the cell found.
template <class Real>
void check_found(int pairs, double tolerance, const gonio::grid& cells) {
  const cell_finder<Real> find(cells);
  std::mt19937_64 generator(7);
  double worst = 0.0;
  int neighbours = 0, missing = 0;
  for (int i = 0; i < pairs; ++i) {
    const auto exact = scattered_pair(generator, i % 4);
    // The directions as rounded to Real are exact for the finder.
    const direction wi = exact.wi.cast<Real>().template cast<double>(),
                    wo = exact.wo.cast<Real>().template cast<double>();
    const Eigen::Index found = find.at(static_cast<Real>(wi.x()), static_cast<Real>(wi.y()), static_cast<Real>(wi.z()),
                                       static_cast<Real>(wo.x()), static_cast<Real>(wo.y()), static_cast<Real>(wo.z()));
    if (found >= cells.size()) {
      ++missing;
      continue;
    }
    const gonio::half_difference angles = gonio::to_half_difference(wi, wo);
    if (cells.linear(cells.nearest(angles)) == found) continue;
    ++neighbours;
    worst = std::max(worst, outside(cells, cells.cell(found), angles));
  }
  INFO(neighbours << " neighbours of " << pairs << ", worst " << worst << " cells");
  CHECK(missing == 0);
  CHECK(worst < tolerance);
  CHECK(neighbours < pairs / 1000);
}

}  // namespace

TEST_CASE("cell finder: the cell that arc functions find, or a neighbour at the border") {
  check_found<double>(1'000'000, 1e-10, gonio::grid());
  check_found<float>(1'000'000, 5e-5, gonio::grid());  // 1e-6 radians
  check_found<double>(100'000, 1e-10, gonio::grid({13, 7, 31}));
  check_found<double>(100'000, 1e-10, gonio::grid({}, gonio::cell_anchor::lower_corner));
}

TEST_CASE("cell finder: every cell is found from its node") {
  const gonio::valid_cells cells;
  const cell_finder<double> find;
  std::size_t wrong = 0;
  for (Eigen::Index cell = 0; cell < cells.size(); cell += 7) {
    const auto [wi, wo] = gonio::to_directions(cells.angles(cell));
    wrong += find(wi, wo) == cells.linear(cell) ? 0u : 1u;
  }
  CHECK(wrong == 0u);
}

TEST_CASE("cell finder: at the ends of the angles it is where the grid is") {
  const gonio::grid cells;
  const auto expected = [&](const direction& wi, const direction& wo) {
    return cells.linear(cells.nearest(gonio::to_half_difference(wi, wo)));
  };
  const cell_finder<double> find;
  const direction up = direction::UnitZ(), side = gonio::spherical_direction(1.0, 0.0);
  const direction mirrored(-side.x(), 0.0, side.z());
  CHECK(find(up, up) == 0u);
  CHECK(find(side, side) == expected(side, side));
  CHECK(find(side, mirrored) == expected(side, mirrored));
  CHECK(find(mirrored, side) == expected(mirrored, side));
  // Azimuths half a turn apart are equivalent.
  CHECK(find(up, side) % 180 == expected(up, side) % 180);
  const direction low = gonio::spherical_direction(1.5707, 0.3), lower = gonio::spherical_direction(1.5707, 0.31);
  CHECK(find(low, lower) == expected(low, lower));
}

TEST_CASE("cell finder: light and viewer may be exchanged, and made longer") {
  CHECK(rc::check("the same cell", [] {
    std::mt19937_64 generator(*rc::gen::arbitrary<unsigned>());
    const auto [wi, wo] = scattered_pair(generator, *rc::gen::inRange(0, 4));
    const cell_finder<double> find;
    const std::size_t cell = find(wi, wo);
    RC_ASSERT(cell == find(wo, wi));
    RC_ASSERT(cell == find(direction(4.0 * wi), direction(4.0 * wo)));
  }));
}

TEST_CASE("cell finder: below the horizon, and for what is no direction, there is no cell") {
  const cell_finder<float> find;
  const Eigen::Vector3f up(0.0f, 0.0f, 1.0f), down(0.0f, 0.6f, -0.8f), flat(1.0f, 0.0f, 0.0f);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  CHECK(find(up, up) == 0u);
  for (const Eigen::Vector3f& bad : {down, flat, Eigen::Vector3f(nan, 0.0f, 1.0f), Eigen::Vector3f(0.0f, nan, 1.0f),
                                     Eigen::Vector3f(0.0f, 0.0f, nan), Eigen::Vector3f(infinity, 0.0f, 1.0f),
                                     Eigen::Vector3f(0.0f, 0.0f, infinity)}) {
    CHECK(find(up, bad) == cell_finder<float>::none);
    CHECK(find(bad, up) == cell_finder<float>::none);
  }
}
