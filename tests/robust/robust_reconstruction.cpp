#include "../synthetic_materials.hpp"
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/metric/root.hpp>
#include <gonio/robust/robust_reconstruction.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::robust_reconstruction;

static_assert(gonio::estimator<robust_reconstruction<gonio::log>>);
static_assert(gonio::estimator<robust_reconstruction<gonio::log_relative>>);

namespace {

/// Forty materials, one of which is not in the estimator's basis.
struct robust_world {
  static constexpr std::size_t unknown = 3;
  gonio::material_set set = synthetic_materials(small_cells(), 40, 11);
  gonio::brdf_table truth = set.table(unknown);
  gonio::measured<gonio::log> others = gonio::measured{set, gonio::log{}}.without({set.names[unknown]});
  robust_reconstruction<gonio::log> estimator{others};

  [[nodiscard]] gonio::sample_set samples(std::size_t count, const gonio::measurement_defects& defects = {},
                                          std::uint64_t seed = 3) const {
    return gonio::sample_table(truth, gonio::random_cells(small_cells(), count, seed), defects, seed);
  }
};

const robust_world& robust() {
  static const robust_world made;
  return made;
}

/// Returns the RMS logarithmic error over all cells and channels.
double robust_error(const gonio::brdf_table& estimate) {
  double sum = 0.0;
  const auto truth = robust().truth.values();
  for (std::size_t i = 0; i < truth.size(); ++i)
    sum += std::pow(std::log((double{estimate.values()[i]} + 1e-3) / (double{truth[i]} + 1e-3)), 2);
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

template <class Fit>
double error_of(const Fit& fit) {
  return robust_error(fit.tabulate(small_cells()));
}

bool finite_and_not_negative(const gonio::brdf_table& table) {
  return std::ranges::all_of(table.values(), [](float value) { return std::isfinite(value) && value >= 0.0f; });
}

template <class Samples>
void check_same(const robust_reconstruction<gonio::log>& one, const robust_reconstruction<gonio::log>& other,
                const Samples& samples, const gonio::sample_set& others) {
  const auto first = one.fit(samples), second = other.fit(others);
  CHECK(std::ranges::equal(first.correction().values(), second.correction().values()));
  CHECK(std::ranges::equal(first.tabulate(small_cells(), {1}).values(), second.tabulate(small_cells(), {3}).values()));
  REQUIRE(first.history().size() == second.history().size());
  CHECK(first.history().back().error == second.history().back().error);
  CHECK(first.history().back().down_weighted == second.history().back().down_weighted);
}

}  // namespace

TEST_CASE("with 40 % outliers it is far better than the non-negative combination of materials") {
  const gonio::decomposition combination{robust().others, gonio::nnls{}};
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto samples = robust().samples(300, {.outlier_ratio = 0.4, .noise = 0.1}, seed);
    const double plain = error_of(combination.fit(samples)), found = error_of(robust().estimator.fit(samples));
    CHECK(found < 0.1 * plain);
  }
}

TEST_CASE("clean samples are fitted at least as well as by the combination, and a known material exactly") {
  const auto samples = robust().samples(300);
  const gonio::decomposition combination{robust().others, gonio::nnls{}};
  const double plain = error_of(combination.fit(samples)), found = error_of(robust().estimator.fit(samples));
  CHECK(found < 0.2 * plain);

  const robust_reconstruction knowing{gonio::measured{robust().set, gonio::log{}}};
  const auto known = knowing.fit(samples);
  CHECK(error_of(known) < 1e-5);  // float rounding
  // Outliers that are right to a few per cent have a slight effect: the least scale of the mixture, 1 %, cannot
  // separate them.
  CHECK(error_of(knowing.fit(robust().samples(300, {.outlier_ratio = 0.4}))) < 5e-3);
}

TEST_CASE("outliers are recognised: the fraction of down-weighted samples is that of the outliers") {
  const auto fit = robust().estimator.fit(robust().samples(300, {.outlier_ratio = 0.4, .noise = 0.1}));
  // Some outliers are about right by chance, and some inliers are in the tail.
  CHECK(fit.history().back().down_weighted > 0.3);
  CHECK(fit.history().back().down_weighted < 0.45);
}

TEST_CASE("where nothing was measured, the surface is expected to be like the nearest material") {
  const auto peak_ratio = [&](const robust_reconstruction<gonio::log>& estimator, const gonio::sample_set& samples) {
    const auto found = estimator.fit(samples).tabulate(small_cells());
    return double{std::ranges::max(found.values())} / double{std::ranges::max(robust().truth.values())};
  };
  const gonio::correction corrections{robust().others};
  const robust_reconstruction credulous{robust().others, corrections, {}, {.expectation = 0.0}};
  double worst = 1.0, worst_without = 1.0;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    gonio::sample_set samples;
    for (const gonio::sample& s : robust().samples(150, {.outlier_ratio = 0.2, .noise = 0.1}, seed))
      if (s.angles().theta_h >= gonio::radians(15.0)) samples.push_back(s);
    const double with = peak_ratio(robust().estimator, samples), without = peak_ratio(credulous, samples);
    worst = std::max({worst, with, 1.0 / with});
    worst_without = std::max({worst_without, without, 1.0 / without});
  }
  CHECK(worst < 3.0);
  CHECK(worst_without > 10.0);
}

TEST_CASE("any metric of the materials will do") {
  const auto samples = robust().samples(200, {.outlier_ratio = 0.3});
  const auto check = [&](const auto& metric) {
    const auto materials = gonio::measured{robust().set, metric}.without({robust().set.names[robust_world::unknown]});
    const double plain = error_of(gonio::decomposition{materials, gonio::nnls{}}.fit(samples));
    const double found = error_of(robust_reconstruction{materials}.fit(samples));
    // Noell's combinations are not log-relative, and non-negative combinations of differences from a median fit badly.
    CHECK(found < 0.7 * plain);
  };
  check(gonio::lin{});
  check(gonio::root{});
  check(gonio::log_relative::to_median_of(robust().set));
}

TEST_CASE("the same bytes for any number of threads, and the seed matters only where it chooses") {
  const gonio::correction corrections{robust().others};
  const auto with = [&](std::uint64_t seed, Eigen::Index count, unsigned threads) {
    return robust_reconstruction{
        robust().others, corrections, {}, gonio::robust_start{.samples = count, .seed = seed}, {threads}};
  };
  const auto samples = robust().samples(250, {.outlier_ratio = 0.3});
  check_same(with(0, 20'000, 1), with(0, 20'000, 3), samples, samples);
  check_same(with(0, 100, 1), with(0, 100, 2), samples, samples);
  check_same(with(1, 20'000, 1), with(2, 20'000, 1), samples, samples);  // uses all samples
  check_same(robust_reconstruction{robust().others}, with(0, 20'000, 1), samples, samples);
  CHECK_FALSE(std::ranges::equal(with(1, 100, 1).fit(samples).correction().values(),
                                 with(2, 100, 1).fit(samples).correction().values()));
}

TEST_CASE("stepping from the start equals the fit") {
  for (const double outliers : {0.1, 0.6}) {
    const auto samples = robust().samples(400, {.outlier_ratio = outliers});
    auto run = robust().estimator.initialise(samples);
    while (!run.converged()) run.step();
    CHECK(
        std::ranges::equal(run.result().correction().values(), robust().estimator.fit(samples).correction().values()));
  }
}

TEST_CASE("the iteration looks at some of the samples, if there are many") {
  const gonio::correction corrections{robust().others};
  const auto samples = robust().samples(400, {.outlier_ratio = 0.3});
  const auto with = [&](Eigen::Index most, std::uint64_t seed) {
    return robust_reconstruction{robust().others, corrections, {}, {.most_samples = most, .seed = seed}}.fit(samples);
  };
  CHECK(std::ranges::equal(with(400, 1).correction().values(), with(50'000, 2).correction().values()));
  CHECK_FALSE(std::ranges::equal(with(200, 1).correction().values(), with(200, 2).correction().values()));
  const gonio::decomposition combination{robust().others, gonio::nnls{}};
  CHECK(error_of(with(200, 1)) < 0.5 * error_of(combination.fit(samples)));
}

TEST_CASE("a start on some of the samples serves, too") {
  const robust_reconstruction few{robust().others, gonio::correction{robust().others}, {}, {.samples = 100}};
  const auto samples = robust().samples(300, {.outlier_ratio = 0.4});
  const gonio::decomposition combination{robust().others, gonio::nnls{}};
  CHECK(error_of(few.fit(samples)) < 0.5 * error_of(combination.fit(samples)));
}

TEST_CASE("limits: no round leaves the combination, few rounds are counted with the trusting ones") {
  const gonio::correction corrections{robust().others};
  const auto samples = robust().samples(100);
  const auto rounds = [&](const gonio::correction_limits& limits) {
    return robust_reconstruction{robust().others, corrections, limits}.fit(samples).history().size();
  };
  CHECK(rounds({.rounds = 0}) == 0);
  CHECK(rounds({.rounds = 2, .smallest_change = 0.0}) == 2);
  CHECK(rounds({.rounds = 7, .smallest_change = 0.0}) == 7);
}

TEST_CASE("a sample of weight zero changes no byte, and other weights matter") {
  const auto samples = robust().samples(120, {.outlier_ratio = 0.2});
  auto more = samples;
  const gonio::sample ignored{samples[0].angles(), gonio::rgb(40, 50, 60), 0.0};
  more.insert(more.begin(), 3, ignored);
  more.insert(more.begin() + 60, 200, ignored);
  more.push_back(ignored);
  check_same(robust().estimator, robust().estimator, samples, more);
  auto heavier = samples;
  for (std::size_t i = 0; i < 20; ++i) heavier[i].weight = 10.0;
  CHECK_FALSE(std::ranges::equal(robust().estimator.fit(samples).tabulate(small_cells()).values(),
                                 robust().estimator.fit(heavier).tabulate(small_cells()).values()));
}

TEST_CASE("a table is fitted as its cells are; samples between cells are fitted") {
  std::vector<Eigen::Index> every(small_cells().size());
  std::iota(every.begin(), every.end(), std::size_t{0});
  const auto by_table = robust().estimator.fit(robust().truth);
  const auto by_samples = robust().estimator.fit(gonio::sample_table(robust().truth, every));
  CHECK(std::ranges::equal(by_table.correction().values(), by_samples.correction().values()));

  auto between = robust().samples(200, {.outlier_ratio = 0.3});
  for (auto& s : between) {
    auto angles = s.angles();
    angles.theta_h *= 0.97;
    s.directions = angles;
  }
  const gonio::decomposition combination{robust().others, gonio::nnls{}};
  CHECK(error_of(robust().estimator.fit(between)) < 0.5 * error_of(combination.fit(between)));
}

TEST_CASE("random values of random sizes, weights and numbers: finite and not negative") {
  CHECK(rc::check("anything usable", [] {
    const std::size_t count = *rc::gen::inRange(1, 40);
    const auto seed = static_cast<unsigned>(*rc::gen::inRange(0, 10'000));
    auto samples = robust().samples(count, {}, seed);
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    const double spread = *rc::gen::inRange(0, 8);
    for (auto& s : samples) {
      for (double& value : s.value) {
        value = std::exp(spread * normal(generator));
        if (generator() % 8 == 0) value = generator() % 2 == 0 ? -value : 0.0;
      }
      s.weight = std::exp(normal(generator));
    }
    const auto fit = robust().estimator.fit(samples);
    RC_ASSERT(finite_and_not_negative(fit.tabulate(small_cells())));
    for (const auto& round : fit.history()) RC_ASSERT(std::isfinite(round.error) && std::isfinite(round.change));
  }));
}

TEST_CASE("awkward samples: one, two, equal, zero, negative, tiny, large, all at one location") {
  const auto good = robust().samples(50);
  const auto check = [&](const std::string& name, auto&& change, std::size_t count = 50) {
    CAPTURE(name);
    gonio::sample_set samples(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t i = 0; i < samples.size(); ++i) change(samples[i], i);
    const auto fit = robust().estimator.fit(samples);
    CHECK(finite_and_not_negative(fit.tabulate(small_cells())));
    for (const auto& round : fit.history()) CHECK((std::isfinite(round.error) && std::isfinite(round.change)));
    return fit.tabulate(small_cells());
  };
  check(
      "one", [](auto&, auto) {}, 1);
  check(
      "two", [](auto&, auto) {}, 2);
  check("equal", [](auto& s, auto) { s.value.setConstant(0.2); });
  const auto black = check("zero", [](auto& s, auto) { s.value.setZero(); });
  CHECK(std::ranges::max(black.values()) < 0.1f);
  check("negative", [](auto& s, auto) { s.value = -s.value; });
  check("half zero", [](auto& s, auto i) { s.value *= static_cast<double>(i % 2); });
  check("tiny", [](auto& s, auto) { s.value *= 1e-20; });
  check("large", [](auto& s, auto) { s.value *= 1e9; });
  check("some large", [](auto& s, auto i) {
    if (i % 7 == 0) s.value *= 1e12;
  });
  check("at one location", [&](auto& s, auto) { s.directions = good[0].directions; });
  check("one channel black", [](auto& s, auto) { s.value.x() = 0.0; });
}

TEST_CASE("reflectances that leave the range of float are refused, or survived") {
  for (const double size : {1e15, 1e18, 1e22, 1e30, 3e38, 1e39, 1e300})
    for (const bool all : {false, true}) {
      auto samples = robust().samples(30);
      for (std::size_t i = 0; i < samples.size(); ++i)
        if (all || i == 7) samples[i].value.setConstant(size);
      CAPTURE(size);
      CAPTURE(all);
      bool usable = true, finite = true;
      try {
        finite = finite_and_not_negative(robust().estimator.fit(samples).tabulate(small_cells()));
      } catch (const gonio::error&) {
        usable = false;
      }
      CHECK(finite);
      CHECK((usable || size > 3.4e38));  // FLT_MAX
    }
}

TEST_CASE("an estimate that is zero where samples are positive: black materials") {
  auto set = synthetic_materials(small_cells(), 3, 5);
  for (Eigen::Index cell = 0; cell < set.values.rows(); cell += 2) set.values.row(cell).setZero();
  const robust_reconstruction estimator{gonio::measured{set, gonio::log{}}};
  const auto fit = estimator.fit(robust().samples(100));
  CHECK(finite_and_not_negative(fit.tabulate(small_cells())));
  const robust_reconstruction all_black{gonio::measured{
      gonio::material_set{set.cells, set.names, gonio::cell_matrix::Zero(set.values.rows(), 9)}, gonio::log{}}};
  CHECK(finite_and_not_negative(all_black.fit(robust().samples(100)).tabulate(small_cells())));
}

TEST_CASE("the result is zero below the horizon, and evaluates as it tabulates") {
  const auto fit = robust().estimator.fit(robust().samples(100, {.outlier_ratio = 0.3}));
  CHECK((fit({0, 0, 1}, {1, 0, 0}) == 0.0).all());
  CHECK((fit({0, 0, -1}, {0, 0, 1}) == 0.0).all());
  const auto table = fit.tabulate(small_cells());
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell) {
    const auto [wi, wo] = to_directions(small_cells().angles(cell));
    const gonio::rgb direct = fit(wi, wo);
    REQUIRE((table.at(cell) - direct).abs().maxCoeff() <= 4e-6 * (1e-3 + direct.maxCoeff()));
  }
}

TEST_CASE("unusable samples, tables and materials are refused") {
  CHECK_THROWS_WITH_AS(robust().estimator.fit(gonio::sample_set{}), doctest::Contains("no samples"), gonio::error);
  auto samples = robust().samples(10);
  samples[6].value.y() = std::nan("");
  CHECK_THROWS_WITH_AS(robust().estimator.fit(samples), doctest::Contains("sample 7"), gonio::error);
  samples = robust().samples(10);
  for (auto& s : samples) s.weight = 0.0;
  CHECK_THROWS_WITH_AS(robust().estimator.fit(samples), doctest::Contains("weight zero"), gonio::error);
  auto table = robust().truth;
  table.values()[33] = std::nanf("");
  CHECK_THROWS_WITH_AS(robust().estimator.fit(table), doctest::Contains("cell 11"), gonio::error);
  const gonio::measured elsewhere{synthetic_materials(gonio::valid_cells(gonio::grid({5, 5, 5})), 3), gonio::log{}};
  CHECK_THROWS_WITH_AS((robust_reconstruction{robust().others, gonio::correction{elsewhere}}),
                       doctest::Contains("same cells"), gonio::error);
  CHECK_THROWS_WITH_AS((robust_reconstruction{gonio::measured{synthetic_materials(small_cells(), 1), gonio::log{}}}),
                       doctest::Contains("two materials"), gonio::error);
}
