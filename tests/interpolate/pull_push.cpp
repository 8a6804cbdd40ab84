#include "../synthetic_materials.hpp"
#include <gonio/interpolate/pull_push.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <limits>

using gonio::pull_push;
using gonio::rgb;
using gonio::sample_set;
using gonio::valid_cells;

static_assert(gonio::estimator<pull_push> && gonio::tabulated_brdf<gonio::completed_table>);

namespace {

/// A number from 0 to 1.
double fraction() { return 1e-6 * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 1'000'001)); }

/// Returns cells of a grid with any extents from 1 to 12.
valid_cells any_cells() {
  const auto extent = [] { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(1, 13)); };
  const int theta_h = extent(), theta_d = extent();
  return valid_cells(gonio::grid({theta_h, theta_d, extent()}));
}

/// Returns up to 20 samples at locations above the horizon.
sample_set any_samples() {
  sample_set samples;
  const int count = *rc::gen::inRange(1, 21);
  for (int i = 0; i < count; ++i)
    samples.push_back({{0.7 * fraction(), 0.7 * fraction(), 3.14 * fraction()},
                       rgb(fraction(), 2.0 * fraction(), 5.0 + fraction()),
                       0.01 + 2.0 * fraction()});
  return samples;
}

/// Completes one row of cells along phi_d with samples at the given nodes.
std::vector<double> complete_along_phi_d(int extent, const std::vector<std::pair<int, double>>& nodes) {
  const valid_cells cells(gonio::grid({1, 1, extent}));
  sample_set samples;
  for (const auto& [node, value] : nodes)
    samples.push_back({cells.grid().angles({0, 0, node}), rgb::Constant(value), 1.0});
  const auto table = pull_push{cells}.fit(samples).tabulate(cells);
  std::vector<double> values;
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) values.push_back(table.at(cell).x());
  return values;
}

const gonio::brdf_table& truth() {
  static const auto table = synthetic_materials(small_cells(), 3).table(1);
  return table;
}

}  // namespace

TEST_CASE("a full table comes back as it was, from the table and from samples of its cells") {
  const pull_push estimator{small_cells()};
  sample_set samples;
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell)
    samples.push_back({small_cells().angles(cell), truth().at(cell), 1.0 + 0.1 * static_cast<double>(cell % 7)});
  CHECK(std::ranges::equal(estimator.fit(truth()).tabulate(small_cells()).values(), truth().values()));
  CHECK(std::ranges::equal(estimator.fit(samples).tabulate(small_cells()).values(), truth().values()));
  CHECK(estimator.cells() == small_cells());
}

TEST_CASE("completed values lie between the least and the largest measured, and a constant stays one") {
  CHECK(rc::check([] {
    const valid_cells cells = any_cells();
    sample_set samples = any_samples();
    rgb least = samples[0].value, most = least;
    for (const gonio::sample& s : samples) {
      least = least.min(s.value);
      most = most.max(s.value);
    }
    const auto table = pull_push{cells}.fit(samples).tabulate(cells);
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
      RC_ASSERT((table.at(cell) >= least - 1e-5).all());
      RC_ASSERT((table.at(cell) <= most + 1e-5).all());
    }
    for (gonio::sample& s : samples) s.value = rgb(1, 2, 3);
    const auto constant = pull_push{cells}.fit(samples).tabulate(cells);
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell)
      RC_ASSERT((constant.at(cell) - rgb(1, 2, 3)).abs().maxCoeff() < 1e-6);
  }));
}

TEST_CASE("cells measured with full weight keep their weighted mean, whatever is around them") {
  CHECK(rc::check([] {
    const valid_cells cells = any_cells();
    const auto pick = static_cast<std::size_t>(fraction() * static_cast<double>(cells.size() - 1));
    const auto angles = cells.angles(pick);
    sample_set samples;
    for (const gonio::sample& s : any_samples())
      if (!(cells.grid().nearest(s.angles()) == cells.grid().cell(cells.linear(pick)))) samples.push_back(s);
    samples.push_back({angles, rgb(1, 2, 4), 0.5});
    samples.push_back({angles, rgb(5, 6, 0), 1.5});
    const auto table = pull_push{cells}.fit(samples).tabulate(cells);
    RC_ASSERT((table.at(pick) - rgb(4, 5, 1)).abs().maxCoeff() == 0.0);
  }));
}

// By hand, following Gortler et al.: the pairs pull to {8, 0} and {0} (unknown), the top is 8.
TEST_CASE("golden: four cells of which one is known") {
  const auto values = complete_along_phi_d(4, {{0, 8.0}});
  CHECK(std::ranges::equal(values, std::vector<double>{8, 8, 8, 8}));
}

// Pairs: (8 known, weight 1), (4 known, weight 1). Unknown cell 1 is 3/4 of its own pair and 1/4 of the next. Unknown
// cell 3 wraps to the first pair.
TEST_CASE("golden: linear interpolation between pairs, which wraps") {
  const auto values = complete_along_phi_d(4, {{0, 8.0}, {2, 4.0}});
  CHECK(std::ranges::equal(values, std::vector<double>{8, 7, 4, 5}));
}

// Five cells: pairs with centres at 1, 3 and 4.5, the last of a single cell. The next pair to its right is at 6.
TEST_CASE("golden: an odd number of cells is interpolated between true centres") {
  const auto values = complete_along_phi_d(5, {{0, 3.0}, {2, 6.0}, {4, 9.0}});
  CHECK(values[0] == 3.0);
  CHECK(values[1] == doctest::Approx(3.75));  // at 1.5, between 3 at 1 and 6 at 3
  CHECK(values[2] == 6.0);
  CHECK(values[3] == doctest::Approx(7.0));  // at 3.5, between 6 at 3 and 9 at 4.5
  CHECK(values[4] == 9.0);
}

TEST_CASE("phi_d wraps: shifting all samples along it by a power of two shifts the table") {
  const auto shifted = [](int by) {
    std::vector<std::pair<int, double>> nodes;
    for (const auto& [node, value] : {std::pair{1, 3.0}, {2, 5.0}, {9, 1.0}, {15, 7.0}})
      nodes.emplace_back((node + by) % 16, value);
    return complete_along_phi_d(16, nodes);
  };
  const auto here = shifted(0), there = shifted(8);
  for (std::size_t k = 0; k < 16; ++k) CHECK(there[(k + 8) % 16] == doctest::Approx(here[k]));
  CHECK(std::ranges::max(here) > std::ranges::min(here) + 5.0);
}

TEST_CASE("phi_d wraps for any number of cells: the last is next to the first") {
  for (const int extent : {3, 5, 6, 7, 9, 11, 18, 45}) {
    std::vector<std::pair<int, double>> nodes;
    for (int k = 0; k < extent; ++k)
      if (k != extent - 1) nodes.emplace_back(k, k == 0 ? 1.0 : 0.0);
    // The missing last cell is next to the first across the wrap.
    CHECK(complete_along_phi_d(extent, nodes).back() > 0.0);
  }
}

TEST_CASE("theta_h does not wrap") {
  const valid_cells cells(gonio::grid({8, 1, 1}));
  sample_set samples;
  for (int h = 0; h < 6; ++h)
    samples.push_back({cells.grid().angles({h, 0, 0}), rgb::Constant(h == 0 ? 100.0 : 1.0), 1.0});
  REQUIRE(cells.size() >= 7);
  const auto table = pull_push{cells}.fit(samples).tabulate(cells);
  CHECK(table.at(6).x() < 30.0);
  CHECK(table.at(0).x() == 100.0);
}

TEST_CASE("the finer levels decide where they know something: smooth materials from a few cells") {
  sample_set samples;
  for (Eigen::Index cell = 0; cell < small_cells().size(); cell += 3)
    samples.push_back({small_cells().angles(cell), truth().at(cell), 1.0});
  const auto table = pull_push{small_cells()}.fit(samples).tabulate(small_cells());
  double error = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < table.values().size(); ++i) {
    error += std::abs(double{table.values()[i]} - double{truth().values()[i]});
    spread += std::abs(double{truth().values()[i]} - double{truth().values()[3 * (i / 9)]});
  }
  CHECK(error < 0.2 * spread);
}

TEST_CASE("fits do not depend on the number of threads, and tabulating agrees with evaluating") {
  sample_set samples;
  for (Eigen::Index cell = 0; cell < small_cells().size(); cell += 5)
    samples.push_back({small_cells().angles(cell), truth().at(cell), 0.3});
  const auto fit = pull_push{small_cells(), {1}}.fit(samples), threaded = pull_push{small_cells(), {3}}.fit(samples);
  CHECK(std::ranges::equal(fit.table().values(), threaded.table().values()));
  for (const auto& over : {small_cells(), valid_cells(gonio::grid({13, 6, 20}))}) {
    const auto table = fit.tabulate(over);
    for (Eigen::Index cell = 0; cell < over.size(); ++cell) {
      const auto [wi, wo] = to_directions(over.angles(cell));
      REQUIRE((table.at(cell) - fit(wi, wo)).abs().maxCoeff() < 1e-5 * (1.0 + table.at(cell).maxCoeff()));
    }
  }
  CHECK((fit({0, 0, 1}, {1, 0, 0}) == 0.0).all());
  CHECK((fit({0, 0, -1}, {0, 0, 1}) == 0.0).all());
}

TEST_CASE("a table over other cells is taken at the nearest ones") {
  const valid_cells coarse(gonio::grid({3, 3, 3}));
  const auto table = pull_push{coarse}.fit(truth()).tabulate(coarse);
  CHECK(std::ranges::all_of(table.values(), [](float value) { return value > 0.0f; }));
}

TEST_CASE("negative measurements are averaged as they are; negative results become zero") {
  const valid_cells cells(gonio::grid({4, 4, 4}));
  const auto at = cells.angles(0), elsewhere = cells.angles(cells.size() - 1);
  const auto table =
      pull_push{cells}.fit(sample_set{{at, rgb(-1, 4, -3), 1.0}, {at, rgb(3, -2, 1), 1.0}, {elsewhere, rgb(-1, 1, 1)}});
  CHECK((table.table().at(0) - rgb(1, 1, 0)).abs().maxCoeff() == 0.0);
  CHECK(table.table().at(cells.size() - 1).x() == 0.0);
}

TEST_CASE("unusable samples are refused") {
  const pull_push estimator{small_cells()};
  CHECK_THROWS_WITH_AS(estimator.fit(sample_set{}), doctest::Contains("no samples"), gonio::error);
  sample_set samples{{{0.1, 0.2, 0.3}, rgb(1, 1, 1), 0.0}, {{0.3, 0.2, 0.3}, rgb(1, 1, 1), 0.0}};
  CHECK_THROWS_WITH_AS(estimator.fit(samples), doctest::Contains("weight zero"), gonio::error);
  samples[1].value.y() = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS(estimator.fit(samples), doctest::Contains("sample 2"), gonio::error);
  samples[1] = {{0.3, 2.0, 0.3}, rgb(1, 1, 1), 1.0};
  CHECK_THROWS_WITH_AS(estimator.fit(samples), doctest::Contains("horizon"), gonio::error);
}
