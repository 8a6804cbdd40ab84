#include "scattered_pairs.hpp"
#include <gonio/render/grid_coordinates.hpp>
#include <gonio/table/valid_cells.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <limits>
#include <random>

using gonio::direction;
using scattered::outside;
using scattered::scattered_pair;

namespace {

template <class Real>
gonio::render::grid_coordinates<Real> coordinates_of(const direction& wi, const direction& wo) {
  const auto number = [](double value) { return static_cast<Real>(value); };
  return gonio::render::to_grid_coordinates(number(wi.x()), number(wi.y()), number(wi.z()), number(wo.x()),
                                            number(wo.y()), number(wo.z()));
}

/// Returns the cell that contains these coordinates.
template <class Real>
gonio::cell_index cell_of(const gonio::grid& cells, const gonio::render::grid_coordinates<Real>& at) {
  const auto [h, d, p] = cells.extents();
  const auto whole = [](Real coordinate, int extent) {
    return static_cast<int>(coordinate * static_cast<Real>(extent));
  };
  return {std::min(whole(at.theta_h, h), h - 1), std::min(whole(at.theta_d, d), d - 1), whole(at.phi_d, p) % p};
}

/// Checks that the exact location is outside the cell found by at most `tolerance` cells.
template <class Real>
void check_found(int pairs, double tolerance, const gonio::grid& cells) {
  std::mt19937_64 generator(7);
  double worst = 0.0;
  int neighbours = 0;
  for (int i = 0; i < pairs; ++i) {
    const auto exact = scattered_pair(generator, i % 4);
    // The directions as rounded to Real are the exact input.
    const direction wi = exact.wi.cast<Real>().template cast<double>(),
                    wo = exact.wo.cast<Real>().template cast<double>();
    const gonio::cell_index cell = cell_of(cells, coordinates_of<Real>(wi, wo));
    const gonio::half_difference angles = gonio::to_half_difference(wi, wo);
    if (cell == cells.nearest(angles)) continue;
    ++neighbours;
    worst = std::max(worst, outside(cells, cell, angles));
  }
  MESSAGE(neighbours << " of " << pairs << " pairs are in a neighbour of their cell, by at most " << worst << " cells");
  CHECK(worst < tolerance);
  CHECK(neighbours < pairs / 1000);
}

}  // namespace

TEST_CASE("grid coordinates: the cell that arc functions find, or a neighbour at the border") {
  check_found<double>(1'000'000, 1e-10, gonio::grid());
  check_found<float>(1'000'000, 5e-5, gonio::grid());  // 1e-6 radians
  check_found<double>(100'000, 1e-10, gonio::grid({13, 7, 31}));
}

TEST_CASE("grid coordinates: every cell is found from its node") {
  const gonio::valid_cells cells;
  std::size_t wrong = 0;
  for (Eigen::Index cell = 0; cell < cells.size(); cell += 7) {
    const auto [wi, wo] = gonio::to_directions(cells.angles(cell));
    wrong += cells.grid().linear(cell_of(cells.grid(), coordinates_of<double>(wi, wo))) == cells.linear(cell) ? 0u : 1u;
  }
  CHECK(wrong == 0u);
}

TEST_CASE("grid coordinates: as near to the exact ones as they say") {
  std::mt19937_64 generator(3);
  double worst = 0.0, worst_in_float = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    const auto [wi, wo] = scattered_pair(generator, 0);
    const auto angles = gonio::to_half_difference(wi, wo);
    const auto far = [&](const auto& found) {
      const double phi = std::abs(static_cast<double>(found.phi_d) - angles.phi_d / std::numbers::pi);
      return std::max(
          {std::abs(static_cast<double>(found.theta_h) - std::sqrt(angles.theta_h * 2.0 / std::numbers::pi)),
           std::abs(static_cast<double>(found.theta_d) - angles.theta_d * 2.0 / std::numbers::pi),
           std::min(phi, 1.0 - phi) * std::sin(angles.theta_d) * std::sin(angles.theta_h)});
    };
    worst = std::max(worst, far(coordinates_of<double>(wi, wo)));
    worst_in_float = std::max(worst_in_float, far(coordinates_of<float>(wi, wo)));
  }
  MESSAGE("off by at most " << worst << ", in float " << worst_in_float);
  CHECK(worst < 1e-13);
  CHECK(worst_in_float < 4e-7);  // rounding directions to float alone gives 1e-7
}

TEST_CASE("grid coordinates: at the ends of the angles") {
  const gonio::grid cells;
  const auto check = [&](const direction& wi, const direction& wo) {
    const auto expected = cells.nearest(gonio::to_half_difference(wi, wo));
    CHECK(cell_of(cells, coordinates_of<double>(wi, wo)) == expected);
    CHECK(cell_of(cells, coordinates_of<double>(wo, wi)) == expected);
  };
  const direction up = direction::UnitZ(), side = gonio::spherical_direction(1.0, 0.0);
  check(up, up);
  check(side, side);
  check(side, {-side.x(), 0.0, side.z()});
  check(up, side);
  check(gonio::spherical_direction(1.5707, 0.3), gonio::spherical_direction(1.5707, 0.31));
}

TEST_CASE("grid coordinates: light and viewer may be exchanged, and made longer") {
  CHECK(rc::check("the same location", [] {
    std::mt19937_64 generator(*rc::gen::arbitrary<unsigned>());
    const auto [wi, wo] = scattered_pair(generator, *rc::gen::inRange(0, 4));
    const auto at = coordinates_of<double>(wi, wo);
    const auto same = [&](const gonio::render::grid_coordinates<double>& other) {
      const double phi = std::abs(at.phi_d - other.phi_d);
      return std::abs(at.theta_h - other.theta_h) < 1e-12 && std::abs(at.theta_d - other.theta_d) < 1e-12 &&
             std::min(phi, 1.0 - phi) < 1e-12;
    };
    RC_ASSERT(same(coordinates_of<double>(wo, wi)));
    RC_ASSERT(same(coordinates_of<double>(4.0 * wi, 4.0 * wo)));
  }));
}

TEST_CASE("grid coordinates: below the horizon, and what is no direction") {
  const auto is_above = [](const Eigen::Vector3f& wi, const Eigen::Vector3f& wo) {
    return gonio::render::is_above_horizon(wi.x(), wi.y(), wi.z(), wo.x(), wo.y(), wo.z());
  };
  const Eigen::Vector3f up(0.0f, 0.0f, 1.0f), down(0.0f, 0.6f, -0.8f), flat(1.0f, 0.0f, 0.0f);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  CHECK(is_above(up, up));
  for (const Eigen::Vector3f& bad : {down, flat, Eigen::Vector3f(nan, 0.0f, 1.0f), Eigen::Vector3f(0.0f, nan, 1.0f),
                                     Eigen::Vector3f(0.0f, 0.0f, nan), Eigen::Vector3f(infinity, 0.0f, 1.0f),
                                     Eigen::Vector3f(0.0f, 0.0f, infinity)}) {
    CHECK_FALSE(is_above(up, bad));
    CHECK_FALSE(is_above(bad, up));
  }
}
