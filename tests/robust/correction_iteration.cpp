#include "../golden_noell.hpp"
#include "../synthetic_materials.hpp"
#include "tukey_weights.hpp"
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/interpolate/completed_table.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/robust/correction_iteration.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::correction_iteration;
using gonio::correction_limits;
using gonio::correction_run;

namespace {

using combination = gonio::decomposition<gonio::measured<gonio::log>, gonio::nnls>;
static_assert(gonio::estimator<combination>);
static_assert(gonio::estimator<correction_iteration<combination>>);
static_assert(gonio::estimator<correction_iteration<combination, gonio::relative_deviation_weights>>);
static_assert(gonio::tabulated_brdf<gonio::corrected_brdf<gonio::completed_table>>);

/// Full weights, except that the first sample has always the same negligible weight, 1e-30.
struct steady_ones {
  gonio::channel_values weigh(const gonio::channel_values& measured, const gonio::channel_values&) const {
    gonio::channel_values weights = gonio::channel_values::Ones(3, measured.cols());
    weights.col(0).setConstant(1e-30f);
    return weights;
  }
};

/// As steady_ones, but the negligible weight of the first sample changes in each round. The normal equations are
/// rebuilt and must stay the same.
struct restless_ones {
  gonio::channel_values weigh(const gonio::channel_values& measured, const gonio::channel_values& estimated) const {
    gonio::channel_values weights = steady_ones{}.weigh(measured, estimated);
    weights.col(0) *= 1.0f + estimated.col(0);
    return weights;
  }
};
static_assert(gonio::outlier_weighting<steady_ones> && gonio::outlier_weighting<restless_ones>);

constexpr std::size_t held_out = 4;

/// Materials, one of which is held out and must be found.
struct small_world {
  gonio::material_set set = synthetic_materials(small_cells(), 9);
  gonio::brdf_table truth = set.table(held_out);
  gonio::measured<gonio::log> all{set, gonio::log{}};
  gonio::measured<gonio::log> others = all.without({set.names[held_out]});
  gonio::correction corrections{others};

  [[nodiscard]] gonio::sample_set samples(std::size_t count, const gonio::measurement_defects& defects = {},
                                          std::uint64_t seed = 3) const {
    return gonio::sample_table(truth, gonio::random_cells(small_cells(), count, seed), defects, seed);
  }
};

const small_world& world() {
  static const small_world made;
  return made;
}

/// Returns the RMS logarithmic error over all cells and channels.
double log_error(const gonio::brdf_table& estimate, const gonio::brdf_table& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.values().size(); ++i)
    sum += std::pow(std::log((double{estimate.values()[i]} + 1e-3) / (double{truth.values()[i]} + 1e-3)), 2);
  return std::sqrt(sum / static_cast<double>(truth.values().size()));
}

template <class Run>
void run_to_the_end(Run& run) {
  while (!run.converged()) run.step();
}

bool same_bytes(const gonio::brdf_table& one, const gonio::brdf_table& other) {
  return std::ranges::equal(one.values(), other.values());
}

/// Returns difficult sample sets, with their names.
std::vector<std::pair<std::string, gonio::sample_set>> difficult_samples() {
  const auto good = world().samples(40);
  const auto changed = [&](auto&& change) {
    auto samples = good;
    for (std::size_t i = 0; i < samples.size(); ++i) change(samples[i], i);
    return samples;
  };
  std::vector<std::pair<std::string, gonio::sample_set>> all;
  all.emplace_back("one", gonio::sample_set(good.begin(), good.begin() + 1));
  all.emplace_back("two", gonio::sample_set(good.begin(), good.begin() + 2));
  all.emplace_back("all equal", changed([](auto& s, auto) { s.value.setConstant(0.2); }));
  all.emplace_back("zero", changed([](auto& s, auto) { s.value.setZero(); }));
  all.emplace_back("negative", changed([](auto& s, auto) { s.value = -s.value; }));
  all.emplace_back("some zero", changed([](auto& s, auto i) {
                     if (i % 3 == 0) s.value.setZero();
                   }));
  all.emplace_back("tiny", changed([](auto& s, auto) { s.value *= 1e-12; }));
  all.emplace_back("huge", changed([](auto& s, auto) { s.value *= 1e8; }));
  all.emplace_back("all at one location", changed([&](auto& s, auto) { s.directions = good[0].directions; }));
  all.emplace_back("weights of many sizes", changed([](auto& s, auto i) { s.weight = i % 2 == 0 ? 1e-9 : 1e6; }));
  all.emplace_back("one channel black", changed([](auto& s, auto) { s.value.y() = 0.0; }));
  return all;
}

}  // namespace

TEST_CASE("golden: ten rounds as printed, clean and with outliers") {
  const golden_noell& golden = small_golden_noell();
  const auto others = gonio::measured{golden.materials, gonio::log{}}.without({golden.truth_name()});
  const gonio::correction corrections{others, gonio::correction_rule::as_printed()};
  const correction_limits ten{.rounds = 10, .smallest_change = 0.0, .inertia = 0.0};
  const auto check = [&](const std::string& name, bool with_outliers, const auto& weighting) {
    const auto fit = correction_iteration{combination{others}, corrections, weighting, gonio::nnls{}, ten}.fit(
        golden.samples(with_outliers));
    REQUIRE(fit.weights().size() == 10);
    const auto table = fit.tabulate(golden.materials.cells);
    double first = 0.0, last = 0.0, estimate = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Index column = c;
      const nlohmann::json& expected = golden.expected["channels"][c][name];
      for (std::size_t i = 0; i < 11; ++i) {
        const Eigen::Index row = i;
        first = std::max(first, std::abs(fit.weights().front()(row, column) - expected["beta_it1"][i].get<double>()));
        last = std::max(last, std::abs(fit.weights().back()(row, column) - expected["beta_it10"][i].get<double>()));
      }
      for (std::size_t cell = 0; cell < 20; ++cell)
        estimate = std::max(
            estimate,
            std::abs(double{table.values()[3 * cell + c]} / expected["est_final_first20"][cell].get<double>() - 1.0));
      CHECK(golden.mapped_error(fit.initial().tabulate(golden.materials.cells), c) ==
            doctest::Approx(expected["rms_map_lc"].get<double>()).epsilon(1e-5));
      CHECK(golden.mapped_error(table, c) == doctest::Approx(expected["rms_map_final"].get<double>()).epsilon(1e-5));
    }
    // Tables, sigma and products are float here (errors of 1e-7) and double in the reference. The Gram matrix of
    // corrections amplifies the errors of the weights in every round, but not those of the estimate.
    CHECK(first < 1e-5);
    CHECK(last < 1e-4);
    CHECK(estimate < 1e-5);
  };
  check("clean_gamma0", false, gonio::equal_weights{});
  check("outliers_gamma3", true, gonio::relative_deviation_weights{3.0});
}

TEST_CASE("a material that was held out is found better than by the initial estimate") {
  const auto samples = world().samples(150);
  const combination initial{world().others};
  const auto before = log_error(initial.fit(samples).tabulate(small_cells()), world().truth);
  const auto error_with = [&](const auto& weighting) {
    const auto fit = correction_iteration{initial, world().corrections, weighting}.fit(samples);
    return log_error(fit.tabulate(small_cells()), world().truth);
  };
  CHECK(error_with(gonio::equal_weights{}) < 0.5 * before);
  CHECK(error_with(gonio::automatic_weights{}) < 0.5 * before);
  CHECK(error_with(gonio::relative_deviation_weights{}) < 0.5 * before);
  // The weights take the highlight for outliers, since the initial estimate lacks it.
  CHECK(error_with(gonio::tukey_weights{}) < before);
}

TEST_CASE("a material that is in the span is left as it is, and the iteration stops at once") {
  const auto samples = world().samples(150);
  const gonio::correction corrections{world().all};
  const auto fit = correction_iteration{combination{world().all}, corrections}.fit(samples);
  REQUIRE(fit.history().size() == 1);
  CHECK(fit.history()[0].change < 1e-3);
  CHECK(fit.history()[0].error < 1e-3);
  CHECK(fit.history()[0].down_weighted == 0.0);
  CHECK(log_error(fit.tabulate(small_cells()), world().truth) < 1e-3);
  for (const float sigma : fit.correction().values()) REQUIRE(sigma == doctest::Approx(1.0).epsilon(0.01));
  // The constant function has nearly all the weight.
  const Eigen::Index constant = corrections.size() - 1;
  for (Eigen::Index c = 0; c < 3; ++c) CHECK(fit.weights()[0](constant, c) == doctest::Approx(1.0).epsilon(0.02));
}

TEST_CASE("limits end the iteration, and the history has every round") {
  const auto located = gonio::locate_samples(small_cells(), world().samples(60));
  const auto initial = combination{world().others}.fit(world().samples(60));
  const auto rounds_with = [&](const correction_limits& limits) {
    correction_run run{initial, world().corrections, located, gonio::equal_weights{}, gonio::nnls{}, limits};
    run_to_the_end(run);
    CHECK(run.history().size() == run.result().history().size());
    CHECK(run.history().size() == run.result().weights().size());
    return run.history();
  };
  CHECK(rounds_with({.rounds = 0}).empty());
  CHECK(rounds_with({.rounds = -1}).empty());
  CHECK(rounds_with({.rounds = 3, .smallest_change = 0.0}).size() == 3);
  const auto generous = rounds_with({.rounds = 1000, .smallest_change = 0.02});
  CHECK(generous.back().change < 0.02);
  CHECK(generous.size() > 1);
  for (std::size_t i = 0; i + 1 < generous.size(); ++i) CHECK(generous[i].change >= 0.02);
  CHECK(generous.back().error < generous.front().error);
  // With infinite inertia, nothing is corrected.
  const auto inert = rounds_with({.rounds = 5, .inertia = 1e9});
  CHECK(inert.size() == 1);
  CHECK(inert[0].change < 1e-5);
}

TEST_CASE("no round: the result is the initial estimate") {
  const auto initial = combination{world().others}.fit(world().samples(60));
  const correction_run run{initial, world().corrections, gonio::locate_samples(small_cells(), world().samples(60))};
  CHECK_FALSE(run.converged());
  const auto one = run.result().tabulate(small_cells()), other = initial.tabulate(small_cells());
  for (std::size_t i = 0; i < one.values().size(); ++i)  // the offset is added and subtracted again
    REQUIRE(std::abs(one.values()[i] - other.values()[i]) <= 2e-7f * (other.values()[i] + 1e-3f));
}

TEST_CASE("with the constant function thirty rounds are no worse than the best") {  // trap 1 of the reference
  const auto located = gonio::locate_samples(small_cells(), world().truth);
  const auto initial = combination{world().others}.fit(world().truth);
  correction_run run{initial,       world().corrections,
                     located,       gonio::equal_weights{},
                     gonio::nnls{}, {.rounds = 30, .smallest_change = 0.0}};
  double best = 1e9, now = 0.0;
  while (!run.converged()) {
    run.step();
    now = log_error(run.result().tabulate(small_cells()), world().truth);
    best = std::min(best, now);
  }
  REQUIRE(run.history().size() == 30);
  CHECK(now <= 1.05 * best);
  CHECK(best > 0.0);
}

TEST_CASE("stepping by hand is fitting, for any number of threads") {
  const auto samples = world().samples(300, {.outlier_ratio = 0.2});
  const combination estimator{world().others};
  const auto fit = correction_iteration{estimator, world().corrections}.fit(samples);
  for (const unsigned threads : {1u, 3u}) {
    correction_run run{estimator.fit(samples),
                       world().corrections,
                       gonio::locate_samples(small_cells(), samples),
                       gonio::automatic_weights{},
                       gonio::nnls{},
                       {},
                       {threads}};
    run_to_the_end(run);
    CHECK(same_bytes(run.result().correction(), fit.correction()));
    CHECK(same_bytes(run.result().tabulate(small_cells(), {threads}), fit.tabulate(small_cells())));
    REQUIRE(run.history().size() == fit.history().size());
    CHECK(run.history().back().error == fit.history().back().error);
    CHECK(run.history().back().down_weighted == fit.history().back().down_weighted);
  }
}

TEST_CASE("the estimates of a run are the values of its result at the samples") {
  const auto samples = world().samples(50);
  correction_run run{combination{world().others}.fit(samples), world().corrections,
                     gonio::locate_samples(small_cells(), samples)};
  run_to_the_end(run);
  const auto fit = run.result();
  const auto estimated = run.estimated();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Index column = i;
    const auto [wi, wo] = samples[i].directions.pair();
    const gonio::rgb value = fit(wi, wo);
    for (Eigen::Index c = 0; c < 3; ++c) {
      // Float sums of ten products in another order, for each round, and products of the results.
      CHECK(double{estimated(c, column)} == doctest::Approx(value[c]).epsilon(1e-5));
      CHECK(double{run.measured()(c, column)} == doctest::Approx(samples[i].value[c]).epsilon(1e-6));
    }
  }
}

TEST_CASE("weights that stay the same: as if the normal equations were built anew in each round") {
  const auto samples = world().samples(400);
  const combination initial{world().others};
  const correction_limits ten{.rounds = 10, .smallest_change = 0.0};
  const auto fixed = correction_iteration{initial, world().corrections, steady_ones{}, gonio::nnls{}, ten}.fit(samples);
  const auto unknown =
      correction_iteration{initial, world().corrections, restless_ones{}, gonio::nnls{}, ten}.fit(samples);
  // The first rounds are the same.
  CHECK(fixed.weights()[0] == unknown.weights()[0]);
  const auto one = fixed.tabulate(small_cells()), other = unknown.tabulate(small_cells());
  for (std::size_t i = 0; i < one.values().size(); ++i)
    // Right-hand sides are float sums in another order: relative errors of 1e-6, which the Gram matrix amplifies.
    REQUIRE(one.values()[i] == doctest::Approx(double{other.values()[i]}).epsilon(1e-3));
}

TEST_CASE("weights given by hand are taken, whatever the weighting, and are not kept for later rounds") {
  const auto samples = world().samples(100);
  const auto initial = combination{world().others}.fit(samples);
  const auto located = gonio::locate_samples(small_cells(), samples);
  gonio::channel_values first_half = gonio::channel_values::Zero(3, 100);
  first_half.leftCols(50).setOnes();
  correction_run fixed{initial, world().corrections, located, steady_ones{}};
  correction_run unknown{initial, world().corrections, located, restless_ones{}};
  fixed.step(first_half);
  unknown.step(first_half);
  CHECK(fixed.history()[0].down_weighted == 0.5);
  const auto same_weights = [&](double tolerance) {
    return fixed.result().weights().back().isApprox(unknown.result().weights().back(), tolerance);
  };
  CHECK(same_weights(0.0));
  fixed.step();  // the first round that computes its own weights
  unknown.step();
  CHECK(same_weights(0.0));
  fixed.step(first_half);
  unknown.step(first_half);
  CHECK(same_weights(0.0));
}

TEST_CASE("results: cells and directions agree, between cells and on other grids, and are never negative") {
  const auto fit = correction_iteration{combination{world().others}, world().corrections}.fit(
      world().samples(80, {.outlier_ratio = 0.1, .noise = 0.2}));
  for (const auto& over : {small_cells(), gonio::valid_cells(gonio::grid({13, 8, 7}))}) {
    const auto table = fit.tabulate(over), threaded = fit.tabulate(over, {3});
    CHECK(same_bytes(table, threaded));
    for (Eigen::Index cell = 0; cell < over.size(); ++cell) {
      const auto [wi, wo] = to_directions(over.angles(cell));
      const gonio::rgb direct = fit(wi, wo);
      REQUIRE((direct >= 0.0).all());
      // Float products of the initial estimate's rows, times the interpolated factor.
      REQUIRE((table.at(cell) - direct).abs().maxCoeff() <= 4e-6 * (1e-3 + direct.maxCoeff()));
    }
  }
  CHECK((fit({0, 0, 1}, {1, 0, 0}) == 0.0).all());
  CHECK((fit({0, 0, -1}, {0, 0, 1}) == 0.0).all());
  CHECK((fit(gonio::direction(0.6, 0, -0.8), gonio::direction(0, 0, 1)) == 0.0).all());
}

TEST_CASE("samples between cells are fitted as those at cells are") {
  const combination initial{world().others};
  gonio::sample_set samples;
  for (const std::size_t cell : gonio::random_cells(small_cells(), 150, 9)) {
    auto angles = small_cells().angles(cell);
    angles.theta_h *= 0.93;
    const auto [wi, wo] = to_directions(angles);
    samples.push_back({angles, world().truth(wi, wo)});
  }
  gonio::require_usable(samples);
  const auto fit = correction_iteration{initial, world().corrections}.fit(samples);
  const double before = log_error(initial.fit(samples).tabulate(small_cells()), world().truth);
  CHECK(log_error(fit.tabulate(small_cells()), world().truth) < 0.5 * before);
}

TEST_CASE("a table is fitted as its cells are, and one over other cells, too") {
  const correction_iteration estimator{combination{world().others}, world().corrections};
  std::vector<Eigen::Index> every(small_cells().size());
  std::iota(every.begin(), every.end(), std::size_t{0});
  const auto by_table = estimator.fit(world().truth),
             by_samples = estimator.fit(gonio::sample_table(world().truth, every));
  CHECK(same_bytes(by_table.correction(), by_samples.correction()));
  const gonio::valid_cells finer(gonio::grid({14, 9, 11}));
  const auto elsewhere = gonio::resample(world().truth, finer);
  const double before = log_error(combination{world().others}.fit(elsewhere).tabulate(small_cells()), world().truth);
  CHECK(log_error(estimator.fit(elsewhere).tabulate(small_cells()), world().truth) < 0.5 * before);
}

TEST_CASE("a sample of weight zero changes no byte, and other weights matter") {
  const correction_iteration automatic{combination{world().others}, world().corrections};
  const correction_iteration tukey{combination{world().others}, world().corrections, gonio::tukey_weights{}};
  const auto samples = world().samples(60);
  auto with_ignored = samples;
  // Extreme samples of weight zero at the beginning, in the middle and at the end.
  const gonio::sample ignored{samples[3].angles(), gonio::rgb(50, 60, 70), 0.0};
  with_ignored.insert(with_ignored.begin(), 1, ignored);
  with_ignored.insert(with_ignored.begin() + 30, 5, ignored);
  with_ignored.push_back(ignored);
  const auto expect_same = [&](const auto& estimator) {
    const auto one = estimator.fit(samples), other = estimator.fit(with_ignored);
    CHECK(same_bytes(one.tabulate(small_cells()), other.tabulate(small_cells())));
    CHECK(one.history().back().error == other.history().back().error);
    CHECK(one.history().back().down_weighted == other.history().back().down_weighted);
  };
  expect_same(automatic);
  expect_same(tukey);
  auto heavier = samples;
  for (std::size_t i = 0; i < 5; ++i) heavier[i].weight = 20.0;
  CHECK_FALSE(
      same_bytes(automatic.fit(samples).tabulate(small_cells()), automatic.fit(heavier).tabulate(small_cells())));
  for (auto& s : with_ignored) s.weight = 0.0;
  CHECK_THROWS_WITH_AS(automatic.fit(with_ignored), doctest::Contains("weight zero"), gonio::error);
}

TEST_CASE("a channel's corrections follow the weights of that channel") {
  const correction_iteration estimator{combination{world().others}, world().corrections, gonio::equal_weights{}};
  auto apart = world().samples(60), alike = apart;
  for (std::size_t i = 0; i < apart.size(); ++i) {
    const double own = i % 3 == 0 ? 5.0 : 0.5;
    apart[i].weight = gonio::rgb(1.0, own, 2.0);
    alike[i].weight = own;
  }
  const auto one = estimator.fit(apart), other = estimator.fit(alike);
  for (std::size_t round = 0; round < one.weights().size(); ++round) {
    CHECK((one.weights()[round].col(1) - other.weights()[round].col(1)).norm() <
          1e-6 * other.weights()[round].col(1).norm());
    CHECK((one.weights()[round].col(0) - other.weights()[round].col(0)).norm() > 0.0);
  }
}

TEST_CASE("difficult samples give a finite, non-negative BRDF with every weighting") {
  for (const auto& named : difficult_samples()) {
    CAPTURE(named.first);
    const auto check = [&](const auto& weighting, const gonio::correction& corrections) {
      const auto fit = correction_iteration{combination{world().others}, corrections, weighting}.fit(named.second);
      const auto table = fit.tabulate(small_cells());
      for (const float value : table.values()) REQUIRE((std::isfinite(value) && value >= 0.0f));
      for (const auto& round : fit.history()) REQUIRE((std::isfinite(round.error) && std::isfinite(round.change)));
    };
    static const gonio::correction printed{world().others, gonio::correction_rule::as_printed()};
    for (const gonio::correction& corrections : {world().corrections, printed}) {
      check(gonio::equal_weights{}, corrections);
      check(gonio::relative_deviation_weights{}, corrections);
      check(gonio::tukey_weights{}, corrections);
      check(gonio::automatic_weights{}, corrections);
    }
  }
}

TEST_CASE("an estimate that is zero where samples are positive is raised") {
  const gonio::completed_table black(gonio::brdf_table{small_cells()});
  const auto located = gonio::locate_samples(small_cells(), world().samples(100));
  correction_run run{black, world().corrections, located, gonio::equal_weights{}};
  run_to_the_end(run);
  const auto table = run.result().tabulate(small_cells());
  CHECK(std::ranges::all_of(table.values(), [](float value) { return std::isfinite(value) && value >= 0.0f; }));
  CHECK(log_error(table, world().truth) < 0.5 * log_error(gonio::brdf_table{small_cells()}, world().truth));
}

TEST_CASE("unusable samples are refused as everywhere") {
  const correction_iteration estimator{combination{world().others}, world().corrections};
  CHECK_THROWS_WITH_AS(estimator.fit(gonio::sample_set{}), doctest::Contains("no samples"), gonio::error);
  auto samples = world().samples(5);
  samples[3].value.z() = std::nan("");
  CHECK_THROWS_WITH_AS(estimator.fit(samples), doctest::Contains("sample 4"), gonio::error);
  auto table = world().truth;
  table.values()[3 * 17] = std::numeric_limits<float>::infinity();
  CHECK_THROWS_WITH_AS(estimator.fit(table), doctest::Contains("cell 17"), gonio::error);
}
