#include "../synthetic_materials.hpp"
#include <gonio/evaluate/simulated_measurement.hpp>

#include <doctest/doctest.h>

#include <set>

using gonio::random_cells;
using gonio::sample_table;

namespace {

const gonio::brdf_table& table() {
  static const auto synthetic = synthetic_materials(gonio::valid_cells(gonio::grid({18, 18, 24})), 1).table(0);
  return synthetic;
}

}  // namespace

TEST_CASE("random cells are different, in order, and given by the seed") {
  const auto cells = random_cells(table().cells(), 200, 1);
  CHECK(cells.size() == 200);
  CHECK(std::set<Eigen::Index>(cells.begin(), cells.end()).size() == 200);
  CHECK(std::ranges::is_sorted(cells));
  CHECK(cells == random_cells(table().cells(), 200, 1));
  CHECK(cells != random_cells(table().cells(), 200, 2));
  CHECK(random_cells(table().cells(), table().cells().size(), 3).back() == table().cells().size() - 1);
  CHECK_THROWS_AS(static_cast<void>(random_cells(table().cells(), 0, 1)), gonio::error);
  CHECK_THROWS_AS(static_cast<void>(random_cells(table().cells(), table().cells().size() + 1, 1)), gonio::error);
}

TEST_CASE("a share is rounded to a number, at least one") {
  CHECK(gonio::share_of(1000, 0.1234) == 123);
  CHECK(gonio::share_of(1000, 0.1236) == 124);
  CHECK(gonio::share_of(1000, 1.0) == 1000);
  CHECK(gonio::share_of(1000, 0.0) == 1);
}

TEST_CASE("a clean measurement reads the table") {
  const auto cells = random_cells(table().cells(), 50, 4);
  const auto samples = sample_table(table(), cells);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    CHECK((samples[i].value == table().at(cells[i])).all());
    CHECK(samples[i].angles().theta_h == table().cells().angles(cells[i]).theta_h);
    CHECK(samples[i].weight == 1.0);
  }
}

TEST_CASE("exactly the asked share of samples are outliers, and they are values of the table") {
  const auto cells = random_cells(table().cells(), 400, 4);
  const auto clean = sample_table(table(), cells), dirty = sample_table(table(), cells, {.outlier_ratio = 0.25}, 9);
  std::size_t changed = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) changed += (clean[i].value != dirty[i].value).any() ? 1u : 0u;
  CHECK(changed <= 100);
  CHECK(changed > 90);  // a random value may happen to be the same
  const auto again = sample_table(table(), cells, {.outlier_ratio = 0.25}, 9);
  for (std::size_t i = 0; i < cells.size(); ++i) REQUIRE((again[i].value == dirty[i].value).all());
}

TEST_CASE("noise is relative and has the asked deviation") {
  const auto cells = random_cells(table().cells(), 3000, 4);
  const auto clean = sample_table(table(), cells), noisy = sample_table(table(), cells, {.noise = 0.1}, 9);
  double sum = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) sum += (noisy[i].value / clean[i].value - 1.0).square().sum();
  // With 9000 draws the standard error of the deviation is 0.75 %; four times that.
  CHECK(std::sqrt(sum / 9000) == doctest::Approx(0.1).epsilon(0.03));
}

TEST_CASE("misplaced directions are off by the angle and above the horizon") {
  std::mt19937_64 generator(5);
  for (const double theta : {0.0, 0.3, 1.0, 1.57}) {
    const gonio::direction w = gonio::spherical_direction(theta, 2.0);
    for (int trial = 0; trial < 50; ++trial) {
      const gonio::direction off = gonio::misplaced(w, 0.01, generator);
      CHECK(off.norm() == doctest::Approx(1.0));
      CHECK(off.z() > 0.0);
      const double angle = std::atan2(w.cross(off).norm(), w.dot(off));
      CHECK((angle == doctest::Approx(0.01) || (angle < 1e-12 && theta > 1.55)));  // never below the horizon
    }
  }
}

TEST_CASE("a misplaced measurement says the directions that were meant") {
  const std::vector<gonio::direction_pair> pairs{
      {gonio::spherical_direction(0.5, 0.0), gonio::spherical_direction(0.6, 3.0)},
      {gonio::spherical_direction(0.2, 1.0), gonio::spherical_direction(1.2, 0.0)}};
  const auto exact = gonio::sample_table_misplaced(table(), pairs, 0.0),
             off = gonio::sample_table_misplaced(table(), pairs, 0.05, 3);
  REQUIRE(off.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto angles = gonio::to_half_difference(pairs[i].wi, pairs[i].wo);
    CHECK(off[i].angles().theta_h == angles.theta_h);
    CHECK((exact[i].value - table()(pairs[i].wi, pairs[i].wo)).abs().maxCoeff() < 1e-6);
  }
  CHECK((off[0].value - exact[0].value).abs().maxCoeff() > 0.0);
  CHECK((gonio::sample_table_misplaced(table(), pairs, 0.05, 3)[1].value == off[1].value).all());
}

TEST_CASE("impossible defects and directions are refused") {
  const auto cells = random_cells(table().cells(), 5, 4);
  CHECK_THROWS_AS(static_cast<void>(sample_table(table(), cells, {.outlier_ratio = 1.5})), gonio::error);
  CHECK_THROWS_AS(static_cast<void>(sample_table(table(), cells, {.noise = -0.1})), gonio::error);
  const std::vector<gonio::half_difference> below{{0.1, 0.1, 0.1}, {1.4, 1.4, 0.0}};
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::cells_at(table().cells(), below)), doctest::Contains("direction 2"),
                       gonio::error);
}

TEST_CASE("samples of no table are corrupted by values that the caller draws") {
  gonio::sample_set samples(40, {{0.1, 0.2, 0.3}, gonio::rgb(1, 2, 3), 2.0});
  const auto five = [](auto&) { return gonio::rgb(5, 5, 5); };
  const auto corrupted = gonio::corrupt(samples, {.outlier_ratio = 0.25}, 3, five);
  CHECK(std::ranges::count_if(corrupted, [](const auto& s) { return (s.value == 5.0).all(); }) == 10);
  CHECK(std::ranges::count_if(corrupted, [](const auto& s) { return (s.value == gonio::rgb(1, 2, 3)).all(); }) == 30);
  CHECK(corrupted[7].weight == 2.0);
  CHECK_THROWS_AS((void)gonio::corrupt(samples, {.outlier_ratio = std::nan("")}, 3, five), gonio::error);
}

TEST_CASE("parting samples: each is in one part, in order, by the seed") {
  gonio::sample_set samples;
  for (int i = 0; i < 50; ++i) samples.push_back({{0.01 * i, 0.2, 0.3}, gonio::rgb::Constant(i), 1.0});
  const auto [some, others] = gonio::split_samples(samples, 20, 4);
  REQUIRE(some.size() == 20);
  REQUIRE(others.size() == 30);
  const auto value = [](const gonio::sample& s) { return s.value.x(); };
  CHECK(std::ranges::is_sorted(some, {}, value));
  CHECK(std::ranges::is_sorted(others, {}, value));
  gonio::sample_set both = some;
  both.insert(both.end(), others.begin(), others.end());
  std::ranges::sort(both, {}, value);
  for (std::size_t i = 0; i < 50; ++i) CHECK(both[i].value.x() == static_cast<double>(i));
  CHECK(std::ranges::equal(gonio::split_samples(samples, 20, 4).some, some, {}, value, value));
  CHECK_FALSE(std::ranges::equal(gonio::split_samples(samples, 20, 5).some, some, {}, value, value));
  CHECK(gonio::split_samples(samples, 0, 1).some.empty());
  CHECK(gonio::split_samples(samples, 50, 1).others.empty());
  CHECK_THROWS_WITH_AS((void)gonio::split_samples(samples, 51, 1), doctest::Contains("51 of 50"), gonio::error);
}

TEST_CASE("random pairs are those of random cells at random azimuths, and are measured with their azimuths") {
  const auto pairs = gonio::random_pairs(table().cells(), 300, 5);
  const auto cells = random_cells(table().cells(), 300, 5);
  REQUIRE(pairs.size() == 300);
  double azimuths = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto angles = gonio::to_half_difference(pairs[i].wi, pairs[i].wo),
               expected = table().cells().angles(cells[i]);
    CHECK(angles.theta_h == doctest::Approx(expected.theta_h).epsilon(1e-9));
    CHECK(angles.theta_d == doctest::Approx(expected.theta_d).epsilon(1e-9));
    azimuths += gonio::azimuth(pairs[i].wi + pairs[i].wo) > 0.0 ? 1.0 : 0.0;
  }
  CHECK(azimuths / 300.0 == doctest::Approx(0.5).epsilon(0.2));
  const auto brushed = [](const gonio::direction& wi, const gonio::direction& wo) noexcept {
    return gonio::rgb(wi.x() * wo.x() + 2.0, 1.0, 0.5);
  };
  const gonio::sample_set clean = gonio::sample_brdf(brushed, pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    CHECK(clean[i].directions.pair().wi == pairs[i].wi);
    CHECK((clean[i].value == brushed(pairs[i].wi, pairs[i].wo)).all());
  }
  const gonio::sample_set noisy = gonio::sample_brdf(brushed, pairs, {.noise = 0.1}, 3);
  CHECK((noisy[7].value != clean[7].value).all());
  CHECK((noisy[7].value == gonio::sample_brdf(brushed, pairs, {.noise = 0.1}, 3)[7].value).all());
  const gonio::sample_set corrupted = gonio::sample_brdf(brushed, pairs, {.outlier_ratio = 1.0}, 3);
  CHECK(std::ranges::any_of(clean, [&](const gonio::sample& s) { return (s.value == corrupted[0].value).all(); }));
  CHECK_THROWS_AS(static_cast<void>(gonio::sample_brdf(brushed, pairs, {.noise = -1.0})), gonio::error);
  CHECK_THROWS_AS(static_cast<void>(gonio::random_pairs(table().cells(), 0, 1)), gonio::error);
}
