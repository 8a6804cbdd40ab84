#include <gonio/core/error.hpp>
#include <gonio/render/horizon_index.hpp>
#include <gonio/render/padded_grid.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <map>
#include <numeric>
#include <set>

using gonio::render::cell_corner;
using gonio::render::grid_coordinates;
using gonio::render::padded_grid;

namespace {

gonio::grid any_grid() {
  const auto extent = [] { return *rc::gen::inRange(1, 9); };
  const int theta_d = extent();
  // As many cells along theta_h as horizon_index needs, or one.
  return gonio::grid({3 * theta_d, theta_d, extent()},
                     *rc::gen::element(gonio::cell_anchor::centre, gonio::cell_anchor::lower_corner));
}

grid_coordinates<double> any_coordinates() {
  const auto share = [] { return *rc::gen::inRange(0, 1001) / 1000.0; };
  return {share(), share(), share()};
}

/// Returns the cell of each number. Margins map to the cells that they repeat.
std::map<Eigen::Index, Eigen::Index> cell_of_number(const padded_grid& cells) {
  const auto [heights, rows, columns] = cells.grid().extents();
  std::map<Eigen::Index, Eigen::Index> found;
  for (int h = 0; h < heights; ++h)
    for (int d = 0; d < rows; ++d)
      for (int p = -1; p <= columns; ++p)
        found[cells(h, d, p)] = cells.grid().linear({h, d, p < 0 ? columns - 1 : p < columns ? p : 0});
  return found;
}

/// Returns the interpolation weights of cells around a location, summed for each cell.
std::map<Eigen::Index, double> weights_of(const padded_grid& cells, const cell_corner<double>& at) {
  const auto cell = cell_of_number(cells);
  std::map<Eigen::Index, double> weights;
  for (int k = 0; k < 8; ++k) {
    const bool h = (k & 4) != 0, d = (k & 2) != 0, p = (k & 1) != 0;
    const Eigen::Index number = at.number + (h ? cells.step_h() : 0) + (d ? cells.step_d() : 0) + (p ? 1 : 0);
    weights[cell.at(number)] +=
        (h ? at.theta_h : 1 - at.theta_h) * (d ? at.theta_d : 1 - at.theta_d) * (p ? at.phi_d : 1 - at.phi_d);
  }
  return weights;
}

}  // namespace

TEST_CASE("padded grid: numbers count from 0 to its size, each once") {
  for (const gonio::grid& cells : {gonio::grid({1, 1, 1}), gonio::grid({6, 2, 5}), gonio::grid()}) {
    const padded_grid padded(cells);
    const auto found = cell_of_number(padded);
    CHECK(std::ssize(found) == padded.size());
    CHECK(found.begin()->first == 0);
    CHECK(found.rbegin()->first == padded.size() - 1);
  }
}

TEST_CASE("padded grid: the nearest cell, and the weights around, are those of the grid's own index") {
  CHECK(rc::check([] {
    const gonio::grid grid = any_grid();
    const padded_grid padded(grid);
    const gonio::render::horizon_index index(grid);
    const grid_coordinates<double> coordinates = any_coordinates();
    const auto itself = [&](auto... node) { return grid.linear({static_cast<int>(node)...}); };

    const auto corners = index.around(coordinates, itself);
    std::map<Eigen::Index, double> expected;
    for (Eigen::Index k = 0; k < 8; ++k) expected[corners.number[k]] += corners.weight[k];
    const auto found = weights_of(padded, padded.around(coordinates));
    for (const auto& [cell, weight] : expected)
      RC_ASSERT(std::abs(weight - (found.count(cell) == 1 ? found.at(cell) : 0.0)) < 1e-12);
    const double sum = std::accumulate(found.begin(), found.end(), 0.0,
                                       [](double total, const auto& entry) { return total + entry.second; });
    RC_ASSERT(std::abs(sum - 1.0) < 1e-12);
  }));
}

TEST_CASE("padded grid: the nearest cell has the largest weight of those around") {
  CHECK(rc::check([] {
    const padded_grid padded(any_grid());
    const grid_coordinates<double> coordinates = any_coordinates();
    const auto weights = weights_of(padded, padded.around(coordinates));
    const auto nearest = cell_of_number(padded).at(padded.nearest(coordinates));
    const auto largest = std::max_element(weights.begin(), weights.end(), [](const auto& a, const auto& b) {
                           return a.second < b.second;
                         })->second;
    RC_ASSERT(weights.count(nearest) == 1);
    RC_ASSERT(weights.at(nearest) >= largest - 1e-12);
  }));
}

TEST_CASE("padded grid: a grid of more cells than 32 bits count is refused") {
  CHECK_THROWS_WITH_AS(padded_grid(gonio::grid({1000, 1000, 1000})),
                       "a grid for rendering has 1000000000 cells, more than 715827882", gonio::error);
}
